# SPDX-License-Identifier: GPL-3.0-or-later
"""Texts of the interface: the English as it stands in the code, and its translations, in the order of `LOCALES`."""

from __future__ import annotations

from typing import Final

LOCALES: Final = ("ja_JP", "zh_HANS")
"""Blender's names of the languages: Japanese and Simplified Chinese."""

MESSAGES: Final[dict[str, tuple[str, str]]] = {
    "Points": ("ポイント", "点"),
    "How many points were matched": ("マッチングしたポイントの数", "匹配了多少个点"),
    "Source": ("ソース", "源"),
    "Name of the source object": ("ソースオブジェクトの名前", "源物体的名称"),
    "Target": ("ターゲット", "目标"),
    "Name of the target object; of several, of the last one": (
        "ターゲットオブジェクトの名前。複数ある場合は最後のもの",
        "目标物体的名称；有多个时为最后一个",
    ),
    "Name of the target object": ("ターゲットオブジェクトの名前", "目标物体的名称"),
    "Distortion": ("歪み", "畸变"),
    "Distortion of the whole match": ("マッチング全体の歪み", "整个匹配的畸变"),
    "Stretch": ("伸び", "拉伸"),
    "By how much lengths differ between the two meshes on average, by the dense map": (
        "密なマップによる、二つのメッシュの間での長さの平均的な違い",
        "根据稠密映射，两个网格之间长度的平均差异",
    ),
    "Worst Point": ("最悪のポイント", "最差的点"),
    "Largest distortion of a matched point, in units of the square root of the surface area": (
        "対応点の最大の歪み。表面積の平方根を単位とします",
        "匹配点的最大畸变，以表面积的平方根为单位",
    ),
    "Optimum Proven": ("最適性の証明", "已证明最优"),
    "Whether no coarse match has less distortion": (
        "これより歪みの小さい粗いマッチングが存在しないかどうか",
        "是否不存在畸变更小的粗匹配",
    ),
    "Gap": ("ギャップ", "差距"),
    "By how much, at most, the coarse match can be worse than the best one": (
        "粗いマッチングが最良のものより最大でどれだけ劣りうるか",
        "粗匹配最多可能比最佳匹配差多少",
    ),
    "Orientation": ("向き", "朝向"),
    "From 1, left stays left, to -1, the match mirrors the shape": (
        "1では左が左のまま、-1ではマッチングが形状を左右反転します",
        "1 表示左侧仍为左侧，-1 表示匹配使形状左右镜像",
    ),
    "Answers": ("解", "解"),
    "Names of all answers: the direct one and its alternatives, one per line": (
        "すべての解の名前。直接の解とその代替解を1行に1つずつ",
        "所有解的名称：直接解及其替代解，每行一个",
    ),
    "Chosen Answer": ("選ばれた解", "所选解"),
    "Number of the answer that is written on the meshes, from 0 for the direct one": (
        "メッシュに書き込まれている解の番号。直接の解が0",
        "写入网格的解的编号，直接解为 0",
    ),
    "Verdict": ("判定", "判定"),
    "How far the dense map can be trusted, in a sentence; empty if there is none": (
        "密なマップをどこまで信頼できるかを一文で示します。マップがなければ空です",
        "用一句话说明稠密映射的可信程度；没有映射时为空",
    ),
    "Overlap": ("重なり", "重叠"),
    "Confidence": ("信頼度", "置信度"),
    "How far the dense map can be trusted as a whole": (
        "密なマップ全体をどこまで信頼できるか",
        "稠密映射整体的可信程度",
    ),
    "Out of Date": ("期限切れ", "已过期"),
    "Why the match is out of date; empty as long as it is not known to be": (
        "マッチングが古くなった理由。古いと判明していない間は空です",
        "匹配过期的原因；未发现过期时为空",
    ),
    "Swapped": ("入れ替え済み", "已互换"),
    "Whether source and target were exchanged since they were matched": (
        "マッチング後にソースとターゲットが入れ替えられたかどうか",
        "匹配之后源与目标是否被互换",
    ),
    "Lost": ("消失", "已失去"),
    "Whether one of its meshes was deleted, or carries the match no more": (
        "そのメッシュの一方が削除されたか、マッチングをもう持っていないかどうか",
        "其中一个网格是否已被删除或不再带有该匹配",
    ),
    "Of Others": ("別のペア", "其他网格"),
    "Whether the match is of other meshes than those that are picked": (
        "選ばれているものとは別のメッシュのマッチングかどうか",
        "是否是所选网格以外其他网格的匹配",
    ),
    "Seconds": ("秒", "秒"),
    "How long the match took; zero if that is not known": (
        "マッチングにかかった時間。不明な場合は0です",
        "匹配所用的时间；未知时为零",
    ),
    "Notes": ("注記", "备注"),
    "What should be known about the match, one sentence per line": (
        "マッチングについて知っておくべきこと。一行に一文です",
        "关于此匹配应了解的事项，每行一句",
    ),
    "Prefix": ("接頭辞", "前缀"),
    "What the names of everything that was written start with": (
        "書き込まれたすべてのものの名前の先頭に付く文字列",
        "所有写入内容的名称开头",
    ),
    "Key": ("キー", "键"),
    "By what the two meshes are recognised as the pair of this match": (
        "二つのメッシュがこのマッチングのペアだと識別するためのもの",
        "用来识别这两个网格属于此匹配的标识",
    ),
    (
        "Mesh that is matched, or an armature or an empty with all meshes that hang on it; if nothing is picked, what "
        "is active"
    ): (
        (
            "マッチするメッシュ、またはアーマチュアかエンプティとそれに付くすべてのメッシュ。何も指定されていなければア"
            "クティブなもの"
        ),
        "要匹配的网格，或骨架或空物体及其下的所有网格；未选取时使用活动的物体",
    ),
    (
        "Mesh that corresponding points are sought on, or an armature or an empty with all meshes that hang on it; if "
        "nothing is picked, what else is selected"
    ): (
        (
            "対応するポイントを探すメッシュ、またはアーマチュアかエンプティとそれに付くすべてのメッシュ。何も指定されて"
            "いなければ選択中のほかのもの"
        ),
        "在其上寻找对应点的网格，或骨架或空物体及其下的所有网格；未选取时使用其余选中的物体",
    ),
    "Source Collection": ("ソースコレクション", "源集合"),
    "Target Collection": ("ターゲットコレクション", "目标集合"),
    "Collection whose meshes are the source together, if no object is picked": (
        "オブジェクトが選ばれていないとき、まとめてソースとなるメッシュのコレクション",
        "未选取物体时，以此集合中的网格共同作为源",
    ),
    "Collection whose meshes are the target together, if no object is picked": (
        "オブジェクトが選ばれていないとき、まとめてターゲットとなるメッシュのコレクション",
        "未选取物体时，以此集合中的网格共同作为目标",
    ),
    "Summary": ("概要", "摘要"),
    "The last match": ("最後のマッチング", "上一次匹配"),
    "How many points of the source are matched at the finest level": (
        "最も細かいレベルでマッチングするソースのポイントの数",
        "在最精细的层级上匹配源的多少个点",
    ),
    "Coarse Points": ("粗いポイント", "粗匹配点"),
    "How many points are matched exactly, by branch and bound, before all others": (
        "ほかのすべてより先に、分枝限定法で厳密にマッチングするポイントの数",
        "先于其他所有点，用分支定界法精确匹配多少个点",
    ),
    "Coarse Candidates": ("粗い候補", "粗匹配候选"),
    "How many points of the target the coarse points may be matched to": (
        "粗いポイントの相手になりうるターゲットのポイントの数",
        "粗匹配点可以对应到目标上的多少个点",
    ),
    "Solver": ("ソルバー", "解算器"),
    "How the points are matched": ("ポイントをマッチングする方法", "匹配各点的方法"),
    "Hierarchical": ("階層的", "分层"),
    "Some points exactly, then more and more, level by level": (
        "まず一部のポイントを厳密に、それからレベルごとに数を増やします",
        "先精确匹配一些点，再逐级匹配越来越多的点",
    ),
    "Flat": ("フラット", "平面"),
    "All points at once, exactly: for comparison, and for some 30 points at most": (
        "すべてのポイントを一度に厳密にマッチングします。比較用で、ポイントは30程度までです",
        "一次性精确匹配所有点：用于比较，最多约 30 个点",
    ),
    "Generalized Multidimensional Scaling": ("一般化多次元尺度構成法", "广义多维尺度分析"),
    "From the coarse match, points move over the target by their distances alone: for comparison": (
        "粗いマッチングから始め、距離だけに従ってポイントをターゲット上で動かします。比較用です",
        "从粗匹配出发，各点仅依据距离在目标上移动：用于比较",
    ),
    "Dense Map": ("密なマップ", "稠密映射"),
    (
        "Find the corresponding point for every vertex of both meshes. The matched points then lie where this map "
        "takes them"
    ): (
        "両方のメッシュのすべての頂点について対応点を求めます。対応点はこのマップが示す位置に置かれます",
        "为两个网格的每个顶点寻找对应点。匹配点随之位于该映射所指的位置",
    ),
    "Settle": ("落ち着かせる", "安定"),
    (
        "At last let the points leave the samples of the target and come to rest between its vertices (hierarchical "
        "solver without a dense map)"
    ): (
        "最後にポイントをターゲットのサンプルから離し、頂点の間に落ち着かせます(階層的ソルバーで密なマップがない場合)",
        "最后让各点离开目标的采样点，停留在顶点之间（分层解算器且无稠密映射时）",
    ),
    "Metric": ("距離", "度量"),
    "What distances between points of a surface are kept": (
        "表面上のポイント間のどの距離を保つか",
        "保持表面上点与点之间的何种距离",
    ),
    "Geodesic": ("ジオデシック", "测地线"),
    "Length of the shortest path on the surface, by fast marching": (
        "高速マーチング法による、表面上の最短経路の長さ",
        "用快速行进法求得的表面最短路径长度",
    ),
    "Diffusion": ("拡散", "扩散"),
    "How differently heat spreads from two points: less affected by holes and touching parts": (
        "二点からの熱の広がり方の違い。穴や接触した部分の影響を受けにくくなります",
        "热量从两点扩散方式的差异：较少受孔洞和相互接触部位的影响",
    ),
    "Diffusion Time": ("拡散時間", "扩散时间"),
    "How long heat spreads for diffusion distances, in units of the surface area; 0 chooses by the shape": (
        "拡散距離のために熱を広げる時間。表面積を単位とし、0では形状に応じて選びます",
        "计算扩散距离时热量扩散的时长，以表面积为单位；0 表示按形状选择",
    ),
    "Descriptor": ("記述子", "描述符"),
    "By what a point is recognised, beside its distances to the other points": (
        "ほかのポイントとの距離のほかに、何によってポイントを見分けるか",
        "除了到其他点的距离之外，依据什么来识别一个点",
    ),
    "Distance Histograms": ("距離ヒストグラム", "距离直方图"),
    "How many places lie how far away, in the chosen metric": (
        "選んだ距離で、どれだけの場所がどれだけ離れているか",
        "按所选度量，多少位置位于多远处",
    ),
    "Heat Kernel Signatures": ("熱核シグネチャ", "热核签名"),
    "How much heat stays at the point, over time": (
        "時間とともにそのポイントに残る熱の量",
        "随时间推移有多少热量留在该点",
    ),
    "Wave Kernel Signatures": ("波動核シグネチャ", "波核签名"),
    "How strongly the point vibrates, over frequency": (
        "周波数ごとにそのポイントがどれだけ強く振動するか",
        "该点在各频率上的振动强度",
    ),
    "Laplace-Beltrami Eigenfunctions": ("ラプラス・ベルトラミ固有関数", "拉普拉斯-贝尔特拉米特征函数"),
    "Values of the lowest vibrations of the surface, with every consistent choice of their signs": (
        "表面の最も低い振動の値。矛盾のない符号の選び方をすべて考慮します",
        "表面最低频振动的取值，并考虑所有一致的符号选择",
    ),
    "Comparison": ("比較", "比较"),
    "How histograms are compared": ("ヒストグラムの比較方法", "比较直方图的方法"),
    "Earth Mover's": ("アースムーバー距離", "推土机距离"),
    "How far the mass of one has to be moved to make the other": (
        "一方の質量をどれだけ動かせばもう一方になるか",
        "一方的质量需移动多远才能变成另一方",
    ),
    "Bin to Bin": ("ビンごと", "逐柱比较"),
    "The difference in each bin by itself": ("各ビンそれぞれの差", "每一柱各自的差异"),
    "Constraint": ("コンストレイント", "约束"),
    "How points and candidates of the coarse step are to correspond": (
        "粗い段階のポイントと候補の対応のさせ方",
        "粗匹配步骤中点与候选如何对应",
    ),
    "Injective": ("単射", "单射"),
    "Each point gets a candidate of its own; candidates may stay unused": (
        "各ポイントがそれぞれ別の候補を持ちます。使われない候補があってもかまいません",
        "每个点有各自的候选；候选可以不被使用",
    ),
    "Bijective": ("全単射", "双射"),
    "As many candidates as points, and each is used": (
        "候補の数はポイントと同じで、すべて使われます",
        "候选与点一样多，且每个都被使用",
    ),
    "Descriptor Weight": ("記述子のウェイト", "描述符权重"),
    "How much the differences of descriptors count": ("記述子の差をどれだけ重視するか", "描述符的差异占多大比重"),
    "Distance Weight": ("距離のウェイト", "距离权重"),
    "How much the differences of distances between points count": (
        "ポイント間の距離の差をどれだけ重視するか",
        "点间距离的差异占多大比重",
    ),
    "Neighbourhood": ("近傍", "邻域"),
    "Among how many of the target samples around its present match each point looks for a better one": (
        "各ポイントがよりよい相手を探す、現在の相手の周りにあるターゲットのサンプルの数",
        "每个点在当前匹配周围的多少个目标采样中寻找更好的匹配",
    ),
    "Samples": ("サンプル数", "采样"),
    (
        "How many samples of each surface describe it; the points are matched to the samples of the target. With a "
        "dense map three quarters as many are taken, and at least twice as many as points"
    ): (
        (
            "各表面を表すサンプルの数。ポイントはターゲットのサンプルにマッチングされます。密なマップがあると、その四分"
            "の三、ただし少なくともポイントの二倍を取ります"
        ),
        "用多少个采样描述每个表面；各点匹配到目标的采样上。使用稠密映射时取其四分之三，且至少为点数的两倍",
    ),
    "Hypotheses": ("仮説", "假设"),
    (
        "How many distinct coarse matchings are followed up before the best is chosen. Nearly symmetric shapes have "
        "several that are almost equally good. With a dense map half as many are taken"
    ): (
        (
            "最良のものを選ぶまでに追跡する、異なる粗いマッチングの数。ほぼ対称な形状には、ほとんど同じくらいよいものが"
            "複数あります。密なマップがあると、その半分を取ります"
        ),
        "在选出最佳结果之前，继续求解多少个不同的粗匹配。近似对称的形状有若干几乎同样好的结果。使用稠密映射时取其一半",
    ),
    "Histogram Bins": ("ヒストグラムのビン", "直方图柱数"),
    "Number of bins of the distance histograms that describe a point": (
        "ポイントを記述する距離ヒストグラムのビンの数",
        "描述一个点的距离直方图的柱数",
    ),
    "Eigenfunctions": ("固有関数", "特征函数"),
    "How many of the lowest eigenfunctions describe a point": (
        "ポイントの記述に使う最も低い固有関数の数",
        "用多少个最低阶特征函数描述一个点",
    ),
    "Eigenpairs": ("固有対", "特征对"),
    "How many eigenpairs of the Laplace-Beltrami operator make up diffusion distances and kernel signatures": (
        "拡散距離と核シグネチャを構成する、ラプラス・ベルトラミ作用素の固有対の数",
        "用多少个拉普拉斯-贝尔特拉米算子的特征对构成扩散距离和核签名",
    ),
    "Search Limit": ("探索の上限", "搜索上限"),
    "After how many nodes the exact search stops with the best matching so far and a bound on the optimum": (
        "厳密な探索がこの数のノードの後に停止し、それまでの最良のマッチングと最適値の限界を返します",
        "精确搜索在多少个节点之后停止，给出目前最佳的匹配和最优值的界限",
    ),
    "Use Modifiers": ("モディファイアー込み", "使用修改器"),
    (
        "Match the meshes as their shape keys and modifiers show them. Possible unless a modifier adds or removes "
        "vertices"
    ): (
        (
            "シェイプキーとモディファイアーが示す形でメッシュをマッチングします。頂点を増減するモディファイアーがなけれ"
            "ば可能です"
        ),
        "按形态键和修改器所显示的样子匹配网格。只要没有修改器增减顶点即可",
    ),
    "Alternative": ("代替解", "替代解"),
    (
        "For a shape that looks the same from several sides, which of the other answers to write, if there are as "
        "many: 1 is the one in which left and right are exchanged, if there is one. 0 writes the direct answer"
    ): (
        (
            "いくつかの側から同じに見える形状について、他のどの解を書き込むか(それだけの数がある場合)。1は左右を入れ替"
            "えた解です(ある場合)。0では直接の解を書き込みます"
        ),
        (
            "对于从几个方向看都一样的形状，写入其他解中的哪一个（如果有那么多）：1 是左右互换的解（如果有）。0 则写入直"
            "接解"
        ),
    ),
    "Use Landmarks": ("ランドマークを使用", "使用地标"),
    "Keep to the landmarks that the two meshes have in common and that are switched on": (
        "二つのメッシュに共通し、オンになっているランドマークを守ります",
        "遵循两个网格共有且已启用的地标",
    ),
    "Leave Out of Source": ("ソースから除外", "从源中排除"),
    (
        "Vertex group, boolean attribute, material or face set of the source whose vertices are not matched. In the "
        "dense map they follow what is around them"
    ): (
        (
            "頂点をマッチングしない、ソースの頂点グループ、ブール属性、マテリアル、またはフェイスセット。密なマップでは"
            "周囲に従います"
        ),
        "源的顶点组、布尔属性、材质或面组，其顶点不参与匹配。在稠密映射中它们跟随周围的顶点",
    ),
    "Leave Out of Target": ("ターゲットから除外", "从目标中排除"),
    (
        "Vertex group, boolean attribute, material or face set of the target whose vertices are not matched. In the "
        "dense map they follow what is around them"
    ): (
        (
            "頂点をマッチングしない、ターゲットの頂点グループ、ブール属性、マテリアル、またはフェイスセット。密なマップ"
            "では周囲に従います"
        ),
        "目标的顶点组、布尔属性、材质或面组，其顶点不参与匹配。在稠密映射中它们跟随周围的顶点",
    ),
    "What the names of everything that is written start with. Another prefix keeps the results of other matches": (
        "書き込むすべてのものの名前の先頭に付く文字列。接頭辞を変えると、ほかのマッチングの結果が残ります",
        "所有写入内容的名称开头。换用另一个前缀可保留其他匹配的结果",
    ),
    "Vertex Groups": ("頂点グループ", "顶点组"),
    "Write a vertex group for each matched point; groups of the same name are the same point": (
        "対応点ごとに頂点グループを書き込みます。同じ名前のグループが同じポイントです",
        "为每个匹配点写入一个顶点组；同名的组就是同一个点",
    ),
    "Match Colors": ("マッチングカラー", "匹配颜色"),
    "Write a color attribute that gives corresponding places of both meshes the same color": (
        "両方のメッシュの対応する場所に同じ色を与えるカラー属性を書き込みます",
        "写入一个颜色属性，使两个网格的对应位置颜色相同",
    ),
    (
        "Write how much lengths differ around each place, as a color attribute from dark blue (none) to yellow (twice "
        "or half as long), and as an attribute of numbers. Without a dense map: how much the distances to the matched "
        "points differ, yellow being the most"
    ): (
        (
            "各場所の周りで長さがどれだけ異なるかを、暗い青(差なし)から黄(二倍または半分)までのカラー属性と数値の属性と"
            "して書き込みます。密なマップがなければ、対応点までの距離の差を示し、黄が最大です"
        ),
        (
            "写入各处周围长度的差异，既作为从深蓝（无差异）到黄色（两倍或一半）的颜色属性，也作为数值属性。没有稠密映射"
            "时：写入到各匹配点距离的差异，黄色为最大"
        ),
    ),
    (
        "Write how far the dense map can be trusted at each place, as a color attribute from dark red (not at all) to "
        "white (fully)"
    ): (
        "各場所で密なマップをどこまで信頼できるかを、暗い赤(まったく)から白(完全に)までのカラー属性として書き込みます",
        "写入稠密映射在各处的可信程度，作为从深红（完全不可信）到白色（完全可信）的颜色属性",
    ),
    "Fraction": ("割合", "比例"),
    "Part of the match that is done": ("マッチングの完了した割合", "匹配已完成的部分"),
    "Label": ("ラベル", "标签"),
    "What is being done": ("実行中の作業", "正在进行的工作"),
    "Cancel": ("キャンセル", "取消"),
    "Whether the running match is to end": ("実行中のマッチングを終了するかどうか", "是否要结束正在运行的匹配"),
    "Question": ("質問", "问题"),
    "What has to be answered before the work goes on, one sentence per line": (
        "作業を続ける前に答える必要があること。一行に一文",
        "继续之前需要回答的内容，每行一句",
    ),
    "Answer": ("回答", "回答"),
    "The answer; empty as long as there is none": ("回答。まだないうちは空", "回答；尚无回答时为空"),
    "Say what is to become of a match that is not to be trusted": (
        "信頼できないマッチングをどうするかを決めます",
        "决定如何处理不可信的匹配",
    ),
    "What is to be done": ("どうするか", "怎么做"),
    "Match Again with Landmarks": ("ランドマークでやり直す", "用地标重新匹配"),
    "Write nothing, name corresponding places by clicks, and match again": (
        "何も書き込まず、対応する場所をクリックで示してから、もう一度マッチングします",
        "不写入任何内容，点击指出对应的位置，然后重新匹配",
    ),
    "Write Anyway": ("そのまま書き込む", "仍然写入"),
    "Carry everything across the match as it is; one Undo takes it back": (
        "今のマッチングのまま引き継ぎます。一回の「元に戻す」で取り消せます",
        "按现有匹配传递全部内容；撤销一次即可还原",
    ),
    "Write nothing": ("何も書き込みません", "不写入任何内容"),
    "Waiting for an answer": ("回答を待っています", "正在等待回答"),
    "Nothing is asked": ("何も質問されていません", "当前没有需要回答的问题"),
    "Nothing was written. Name corresponding places by clicks, and match again": (
        "何も書き込まれていません。対応する場所をクリックで示して、もう一度マッチングしてください",
        "没有写入任何内容。请点击指出对应的位置，然后重新匹配",
    ),
    "The match is doubtful": ("このマッチングは疑わしいものです", "此匹配可疑"),
    'The match with "{0}" is doubtful. {1}': ("「{0}」とのマッチングは疑わしいものです。{1}", "与“{0}”的匹配可疑。{1}"),
    (
        'The match of "{0}" and "{1}" is doubtful, and nothing was written. {2} Add landmarks and match again, or set '
        "Accept Doubtful to write it all the same."
    ): (
        (
            "「{0}」と「{1}」のマッチングは疑わしいため、何も書き込まれていません。{2}ランドマークを加えてもう一度マッ"
            "チングするか、それでも書き込むには「疑わしくても書き込む」を設定してください。"
        ),
        "“{0}”和“{1}”的匹配可疑，没有写入任何内容。{2}请添加地标后重新匹配；若仍要写入，请设置“接受可疑匹配”。",
    ),
    "Confidence {0}: {1}": ("信頼度{0}：{1}", "置信度 {0}：{1}"),
    "Confidence {0}: {1} Note: {2}": ("信頼度{0}：{1}注意：{2}", "置信度 {0}：{1}注意：{2}"),
    (
        '"{0}" is open at {1} ends and looks like a garment for "{2}": if it is one, fit it with Wear instead; if not, '
        "and the match is wrong, leave out of the other mesh what it lacks."
    ): (
        (
            "「{0}」は{1}か所の端が開いており、「{2}」の衣服のように見えます。衣服なら、代わりに「着せる」で合わせてく"
            "ださい。そうでなく、マッチングが正しくない場合は、これにない部分をもう一方のメッシュから除外してください。"
        ),
        (
            "“{0}”有 {1} 处开口，看起来像是“{2}”的衣服：如果是，请改用“穿戴”使其贴合；如果不是且匹配有误，请在另一个网"
            "格中排除它所没有的部分。"
        ),
    ),
    (
        '"{0}" has a Mirror modifier, and was matched as the half that it is: if the match is wrong, apply the '
        "modifier, and match again."
    ): (
        (
            "「{0}」にはミラーモディファイアーがあり、半分のままマッチングされました。マッチングが正しくない場合は、モ"
            "ディファイアーを適用して、もう一度マッチングしてください。"
        ),
        "“{0}”带有镜像修改器，是按它现有的一半进行匹配的：如果匹配有误，请应用该修改器，然后重新匹配。",
    ),
    'What hangs on single bones of "{0}": {1}. Hide what "{2}" has not, such as weapons, and match again.': (
        (
            "「{0}」で一つのボーンに付いているもの：{1}。武器など「{2}」にないものを隠して、もう一度マッチングしてくだ"
            "さい。"
        ),
        "“{0}”挂在单根骨骼上的有：{1}。请隐藏“{2}”所没有的部分，例如武器，然后重新匹配。",
    ),
    '"{0}" looks like a part of "{1}": if the match is wrong, name what it lacks under Leave Out, and match again.': (
        (
            "「{0}」は「{1}」の一部のように見えます。マッチングが正しくない場合は、これにない部分を「除外」で指定して、"
            "もう一度マッチングしてください。"
        ),
        "“{0}”看起来像是“{1}”的一部分：如果匹配有误，请在“排除”中指定它所没有的部分，然后重新匹配。",
    ),
    "Match": ("マッチング", "匹配"),
    (
        "Find corresponding points of two meshes, whatever their pose, and write them on both as vertex groups and "
        "colors"
    ): (
        "ポーズを問わず二つのメッシュの対応点を求め、両方に頂点グループと色として書き込みます",
        "寻找两个网格的对应点，无论姿态如何，并以顶点组和颜色写入两者",
    ),
    "End the running match or transfer without writing anything": (
        "何も書き込まずに、実行中のマッチングや転送を終了します",
        "结束正在运行的匹配或传递，不写入任何内容",
    ),
    "Use Setup": ("設定例を使用", "使用配置"),
    "Set metric and descriptor as in one of the setups that the paper compares": (
        "論文が比較する設定例の一つと同じ距離と記述子を設定します",
        "将度量和描述符设为论文所比较的某一配置",
    ),
    "Setup": ("設定例", "配置"),
    "Which of the paper's setups to use": ("論文のどの設定例を使うか", "使用论文中的哪个配置"),
    "Geodesic Histograms": ("ジオデシックヒストグラム", "测地线直方图"),
    "Default": ("デフォルト", "默认"),
    "Set Metric to Geodesic, Descriptor to Distance Histograms, as in figure 2 (a) of the paper": (
        "論文の図2(a)のように、「距離」を「ジオデシック」、「記述子」を「距離ヒストグラム」にします",
        "按论文图 2 (a)，将度量设为测地线，描述符设为距离直方图",
    ),
    "Diffusion Histograms": ("拡散ヒストグラム", "扩散直方图"),
    "Set Metric to Diffusion, Descriptor to Distance Histograms, as in figure 2 (b) of the paper": (
        "論文の図2(b)のように、「距離」を「拡散」、「記述子」を「距離ヒストグラム」にします",
        "按论文图 2 (b)，将度量设为扩散，描述符设为距离直方图",
    ),
    "Set Metric to Diffusion, Descriptor to Heat Kernel Signatures, as in figure 2 (c) of the paper": (
        "論文の図2(c)のように、「距離」を「拡散」、「記述子」を「熱核シグネチャ」にします",
        "按论文图 2 (c)，将度量设为扩散，描述符设为热核签名",
    ),
    "Set Metric to Geodesic, Descriptor to Laplace-Beltrami Eigenfunctions, as in figure 2 (d) of the paper": (
        "論文の図2(d)のように、「距離」を「ジオデシック」、「記述子」を「ラプラス・ベルトラミ固有関数」にします",
        "按论文图 2 (d)，将度量设为测地线，描述符设为拉普拉斯-贝尔特拉米特征函数",
    ),
    (
        "Number of the answer: 0 is the direct one, and -1 the one after that which is written; of two answers, the "
        "other one"
    ): (
        "解の番号。0は直接の解、-1は書き込まれている解の次の解です。解が二つなら、もう一方の解です",
        "解的编号：0 是直接解，-1 是已写入的解之后的那个；若有两个解，则为另一个",
    ),
    "Other Answers": ("他の解", "其他解"),
    "Use Another Answer": ("別の解を使用", "使用另一个解"),
    "Use Mirrored Match": ("ミラーマッチングを使用", "使用镜像匹配"),
    (
        "Write another answer of the match, such as the one in which left and right are exchanged, without matching "
        "again. The first answer can be brought back"
    ): (
        "マッチングの別の解(左右を入れ替えたものなど)を、再マッチングせずに書き込みます。最初の解に戻すこともできます",
        "写入匹配的另一个解，例如左右互换的解，无需重新匹配。可以恢复第一个解",
    ),
    "Object": ("オブジェクト", "物体"),
    (
        "Name of one of the two matched objects; if empty, the match of what is picked in the panel is meant, or else "
        "that of the active object"
    ): (
        (
            "マッチングした二つのオブジェクトの一方の名前。空ならパネルで選ばれているもののマッチング、なければアクティ"
            "ブオブジェクトのマッチング"
        ),
        "两个已匹配物体之一的名称；为空时指面板中所选物体的匹配，否则指活动物体的匹配",
    ),
    (
        "What the names that the match wrote start with; needed only for a named or active object that carries several "
        "matches"
    ): (
        (
            "マッチングが書き込んだ名前の先頭。名前で指定した、またはアクティブなオブジェクトが複数のマッチングを持つ場"
            "合にだけ必要です"
        ),
        "匹配所写名称的开头；仅当指定的或活动的物体带有多个匹配时才需要",
    ),
    "Swap Source and Target": ("ソースとターゲットを入れ替え", "互换源与目标"),
    "Exchange Source and Target; the match that the two carry, with its dense map, then serves the other way round": (
        "ソースとターゲットを入れ替えます。両者が持つマッチングは、密なマップも含めて逆向きに使われます",
        "互换源与目标；两者所带的匹配及其稠密映射随之反向使用",
    ),
    "Clear": ("クリア", "清空"),
    (
        "Remove what matches have written on Source, Target and the selected meshes; landmarks and what was carried "
        "over stay"
    ): (
        (
            "マッチングがソース、ターゲット、選択中のメッシュに書き込んだものを削除します。ランドマークと転送されたもの"
            "は残ります"
        ),
        "移除匹配在源、目标和选中网格上写入的内容；地标和已传递的内容会保留",
    ),
    "Name of the object to clear; if empty, the picked Source and Target and all selected meshes": (
        "クリアするオブジェクトの名前。空なら選んだソースとターゲット、および選択中のすべてのメッシュ",
        "要清空的物体名称；为空时为选取的源和目标以及所有选中的网格",
    ),
    "Remove only what was written with this prefix; if empty, everything": (
        "この接頭辞で書き込まれたものだけを削除します。空ならすべて",
        "仅移除用此前缀写入的内容；为空时移除全部",
    ),
    "Export Match": ("対応を書き出し", "导出匹配"),
    (
        "Write the match that two meshes carry into a file, with its dense maps, for other programs or to import it "
        "again"
    ): (
        (
            "二つのメッシュが持つマッチングを密なマップとともにファイルに書き出し、ほかのプログラムや再インポートで使え"
            "るようにします"
        ),
        "将两个网格所带的匹配连同稠密映射写入文件，供其他程序使用或再次导入",
    ),
    "Filter": ("フィルター", "过滤器"),
    "Which files the browser lists": ("ファイルブラウザーに表示するファイル", "文件浏览器列出哪些文件"),
    (
        "Name of one of the two objects; if empty, the one picked in the panel, or the active object, or one of the "
        "match that the panel shows"
    ): (
        (
            "二つのオブジェクトの一方の名前。空ならパネルで選んだもの、アクティブオブジェクトか、パネルに表示中のマッチ"
            "ングの一方"
        ),
        "两个物体之一的名称；为空时使用面板中选取的物体、活动物体，或面板所示匹配的两个物体之一",
    ),
    (
        "Name of the other object; if empty, the one picked in the panel, or the other selected mesh, or the other one "
        "of the match that the panel shows"
    ): (
        (
            "もう一方のオブジェクトの名前。空ならパネルで選んだもの、選択中のもう一つのメッシュか、パネルに表示中のマッ"
            "チングのもう一方"
        ),
        "另一个物体的名称；为空时使用面板中选取的物体、另一个选中的网格，或面板所示匹配的另一个物体",
    ),
    "What the names start with that the match wrote; if empty, the one match that the objects carry": (
        "マッチングが書き込んだ名前の先頭。空なら両オブジェクトが持つ唯一のマッチング",
        "匹配所写名称的开头；为空时使用两个物体所带的唯一匹配",
    ),
    "Import Match": ("対応を読み込み", "导入匹配"),
    (
        "Write a match that was exported to a file on two meshes with the same vertices and faces, in whatever pose, "
        "as if they had just been matched"
    ): (
        (
            "ファイルにエクスポートしたマッチングを、ポーズを問わず、頂点と面が同じ二つのメッシュに、マッチング直後のよ"
            "うに書き込みます"
        ),
        "将导出到文件的匹配写入两个顶点和面相同的网格，无论姿态如何，如同刚刚匹配过一样",
    ),
    "What the names of everything that is written start with": (
        "書き込むすべてのものの名前の先頭に付く文字列",
        "所有写入内容的名称开头",
    ),
    "Add Demo Pair": ("デモ用ペアを追加", "添加演示对"),
    "Add the same cat twice, in two poses and with two different meshes, to try the matching on": (
        "マッチングを試すために、同じ猫を二つのポーズ、二つの異なるメッシュで追加します",
        "添加同一只猫的两个姿态、两个不同网格，用于试用匹配",
    ),
    "Source Vertices": ("ソースの頂点数", "源顶点数"),
    "About how many vertices the standing cat gets; its faces are mostly quads": (
        "立っている猫のおおよその頂点数。面はほとんどが四角形です",
        "站立的猫大约有多少个顶点；其面大多为四边形",
    ),
    "Target Vertices": ("ターゲットの頂点数", "目标顶点数"),
    "About how many vertices the walking cat gets; its faces are triangles": (
        "歩いている猫のおおよその頂点数。面は三角形です",
        "行走的猫大约有多少个顶点；其面为三角形",
    ),
    "Rigged": ("リグ付き", "带绑定"),
    "Give the standing cat an armature, weights, shape keys and a UV map, to try Retarget on": (
        "リターゲットを試すために、立っている猫にアーマチュア、ウェイト、シェイプキー、UVマップを付けます",
        "为站立的猫添加骨架、权重、形态键和 UV 贴图，用于试用重定向",
    ),
    "Number": ("番号", "编号"),
    "By which the landmark is known on both meshes": (
        "両方のメッシュでランドマークを識別する番号",
        "在两个网格上识别该地标的编号",
    ),
    "Source Vertex": ("ソースの頂点", "源顶点"),
    "Vertex of the source": ("ソースの頂点", "源的顶点"),
    "Target Vertex": ("ターゲットの頂点", "目标顶点"),
    "Vertex of the target that corresponds to it": ("それに対応するターゲットの頂点", "与之对应的目标顶点"),
    "Use": ("使用", "使用"),
    "Whether a match keeps to the landmark": ("マッチングがこのランドマークを守るかどうか", "匹配是否遵循此地标"),
    "Which of the matched points it is, from 1": ("何番目の対応点か。1から数えます", "是第几个匹配点，从 1 开始"),
    "Vertex of the source that is nearest to the point": ("ポイントに最も近いソースの頂点", "源上离该点最近的顶点"),
    "Vertex of the target that is nearest to the point": (
        "ポイントに最も近いターゲットの頂点",
        "目标上离该点最近的顶点",
    ),
    "Source Corners": ("ソースの角", "源角点"),
    "Vertices around the point": ("ポイントの周りの頂点", "该点周围的顶点"),
    "Source Weights": ("ソースのウェイト", "源权重"),
    "Where it is between them": ("それらの間での位置", "它在这些顶点之间的位置"),
    "Target Corners": ("ターゲットの角", "目标角点"),
    "Vertices around the corresponding point": ("対応するポイントの周りの頂点", "对应点周围的顶点"),
    "Target Weights": ("ターゲットのウェイト", "目标权重"),
    (
        "How much the distances from this point to the others differ between the two meshes, in units of the square "
        "root of the surface area"
    ): (
        "このポイントからほかのポイントまでの距離が二つのメッシュの間でどれだけ異なるか。表面積の平方根を単位とします",
        "此点到其他各点的距离在两个网格之间相差多少，以表面积的平方根为单位",
    ),
    "Locked": ("ロック", "已锁定"),
    "Whether the point is a landmark, too": ("このポイントがランドマークでもあるかどうか", "该点是否也是地标"),
    "Landmarks": ("ランドマーク", "地标"),
    "Landmarks that source and target have in common": (
        "ソースとターゲットに共通するランドマーク",
        "源与目标共有的地标",
    ),
    "Landmark": ("ランドマーク", "地标"),
    "The row of the list of landmarks that is active": ("ランドマークのリストでアクティブな行", "地标列表中的活动行"),
    "Matched Points": ("対応点", "匹配点"),
    "The matched points, the worst first": ("対応点。悪いものから順に並びます", "匹配点，最差的排在最前"),
    "Matched Point": ("対応点", "匹配点"),
    "The row of the list of matched points that is active": ("対応点のリストでアクティブな行", "匹配点列表中的活动行"),
    "Before": ("以前", "之前"),
    "What was shown before, as a JSON text; empty if nothing": (
        "以前に表示されていたもの。JSONテキストで、なければ空です",
        "之前显示的内容，为 JSON 文本；没有则为空",
    ),
    "Revision": ("リビジョン", "修订"),
    "Grows with each change of a list": ("リストが変わるたびに増えます", "列表每次更改时递增"),
    "Show in Viewport": ("ビューポートに表示", "在视图中显示"),
    "Draw matched points and landmarks on both meshes in the 3D viewports": (
        "3Dビューポートで両方のメッシュに対応点とランドマークを描画します",
        "在 3D 视图中于两个网格上绘制匹配点和地标",
    ),
    "Draw the matched points, from blue to yellow by distortion": (
        "対応点を歪みに応じて青から黄の色で描画します",
        "绘制匹配点，按畸变由蓝到黄着色",
    ),
    "Lines": ("ライン", "线"),
    "Draw a line between the two places of each point": (
        "各ポイントの二つの位置の間に線を描画します",
        "在每个点的两个位置之间画线",
    ),
    "Numbers": ("番号", "编号"),
    "Write the numbers of landmarks and of the worst points beside them": (
        "ランドマークと最も悪いポイントのそばに番号を表示します",
        "在地标和最差的点旁边写上编号",
    ),
    "Add Landmark": ("ランドマークを追加", "添加地标"),
    (
        "Name two corresponding places, to which matches will keep: in Edit Mode the vertices selected on the two "
        "meshes, one on each; in Object Mode the vertices nearest to two selected empties, or those that you click on"
    ): (
        (
            "マッチングが守る二つの対応する場所を指定します。編集モードでは二つのメッシュで一つずつ選択した頂点、オブジ"
            "ェクトモードでは選択した二つのエンプティに最も近い頂点、またはクリックした頂点です"
        ),
        (
            "指定两个对应位置，供匹配遵循：编辑模式下为两个网格上各选中的一个顶点；物体模式下为离两个选中空物体最近的顶"
            "点，或所点击的顶点"
        ),
    ),
    "Vertex of the source; if negative, the selected one": (
        "ソースの頂点。負なら選択中の頂点",
        "源的顶点；为负时使用选中的顶点",
    ),
    "Vertex of the target; if negative, the selected one": (
        "ターゲットの頂点。負なら選択中の頂点",
        "目标的顶点；为负时使用选中的顶点",
    ),
    "Name of the object that is the source; if empty, the one picked in the panel or else the active object": (
        "ソースであるオブジェクトの名前。空ならパネルで選んだもの、なければアクティブオブジェクト",
        "作为源的物体的名称；为空时使用面板中选取的物体，否则使用活动物体",
    ),
    "Name of the object that is the target; if empty, the one picked in the panel or else the other selected one": (
        "ターゲットとなるオブジェクトの名前。空なら、パネルで選んだもの、なければ選択したもう一方",
        "作为目标的物体的名称；若为空，则为面板中所选的，否则为另一个选中的物体",
    ),
    "Pick Landmarks": ("ランドマークを指定", "拾取地标"),
    "Guide Me": ("案内に従う", "引导我"),
    (
        "Click on nose, hands, feet and tail of both meshes as you are asked for them; S leaves one out. After the "
        "last one, or Enter, the two are matched again with these landmarks"
    ): (
        (
            "求められた順に、両方のメッシュの鼻、手、足、尾をクリックします。Sで飛ばせます。最後まで進むかEnterを押すと"
            "、これらのランドマークでもう一度マッチングします"
        ),
        "按提示依次点击两个网格的鼻子、手、脚和尾巴；按 S 可跳过。完成最后一个或按 Enter 后，用这些地标重新匹配",
    ),
    "Nose": ("鼻", "鼻子"),
    "Left Hand": ("左手", "左手"),
    "Right Hand": ("右手", "右手"),
    "Left Foot": ("左足", "左脚"),
    "Right Foot": ("右足", "右脚"),
    "Tail": ("尾", "尾巴"),
    '{0} ({1} of {2}): click on it on "{3}"    S: leave out': (
        "{0}（{1}/{2}）：「{3}」の上でクリックしてください    S：飛ばす",
        "{0}（{1}/{2}）：请在“{3}”上点击    S：跳过",
    ),
    'Click on "{0}" first, or press S to leave this place out.': (
        "先に「{0}」をクリックするか、Sを押してこの場所を飛ばしてください。",
        "请先点击“{0}”，或按 S 跳过此处。",
    ),
    "No landmark was added, so there is nothing new to match by": (
        "ランドマークが加わっていないので、新しくマッチングする手がかりはありません",
        "没有添加地标，因此没有新的匹配依据",
    ),
    "Matching again with {0}": ("{0}でもう一度マッチングしています", "正在用 {0}重新匹配"),
    "What the landmark is called; double-click to change it": (
        "ランドマークの名前。ダブルクリックで変更できます",
        "地标的名称；双击可更改",
    ),
    (
        "Click on a place of one mesh and then on the corresponding place of the other, pair by pair; Enter or Esc "
        "ends it"
    ): (
        (
            "一方のメッシュの場所をクリックし、次にもう一方の対応する場所をクリックして、ペアごとに指定します。Enterま"
            "たはEscで終了します"
        ),
        "先点击一个网格上的位置，再点击另一个网格上的对应位置，逐对进行；按 Enter 或 Esc 结束",
    ),
    "Remove Landmark": ("ランドマークを削除", "移除地标"),
    "Remove a landmark from both meshes": ("両方のメッシュからランドマークを削除します", "从两个网格中移除一个地标"),
    "Which landmark; if zero, the one that is active in the list": (
        "どのランドマークか。0ならリストでアクティブなもの",
        "哪个地标；为零时使用列表中的活动项",
    ),
    "Switch Landmark": ("ランドマークを切り替え", "切换地标"),
    "Switch a landmark on or off; matches keep to those that are on": (
        "ランドマークをオンまたはオフにします。マッチングはオンのものを守ります",
        "启用或停用地标；匹配遵循已启用的地标",
    ),
    "Whether matches are to keep to it": ("マッチングがこれを守るかどうか", "匹配是否要遵循它"),
    "Select Landmark": ("ランドマークを選択", "选择地标"),
    "Select the two vertices of a landmark, and nothing else of the two meshes": (
        "二つのメッシュで、ランドマークの二つの頂点だけを選択します",
        "选择地标的两个顶点，两个网格上的其他内容均不选",
    ),
    "Clear Landmarks": ("ランドマークをクリア", "清空地标"),
    "Remove all landmarks that source and target have in common": (
        "ソースとターゲットに共通するすべてのランドマークを削除します",
        "移除源与目标共有的所有地标",
    ),
    "Mirror Landmarks": ("ランドマークをミラー", "镜像地标"),
    (
        "Add a landmark on the other side for each that is on one side, by the symmetry of each mesh; the meshes may "
        "be in any pose"
    ): (
        (
            "片側にある各ランドマークについて、各メッシュの対称性に従って反対側にも追加します。メッシュのポーズは問いま"
            "せん"
        ),
        "依据各网格的对称性，为一侧的每个地标在另一侧添加一个；网格可以处于任意姿态",
    ),
    "Save Landmarks": ("ランドマークを保存", "保存地标"),
    "Save the landmarks that source and target have in common to a file": (
        "ソースとターゲットに共通するランドマークをファイルに保存します",
        "将源与目标共有的地标保存到文件",
    ),
    "Warn before a file is overwritten": ("ファイルを上書きする前に警告します", "覆盖文件之前发出警告"),
    "File": ("ファイル", "文件"),
    "Path of the file, a JSON text": ("ファイルのパス（JSONテキスト）", "文件路径（JSON 文本）"),
    "Which files are listed": ("表示するファイル", "列出哪些文件"),
    "Load Landmarks": ("ランドマークを読み込み", "加载地标"),
    "Load landmarks of source and target from a file": (
        "ソースとターゲットのランドマークをファイルから読み込みます",
        "从文件加载源与目标的地标",
    ),
    "Replace": ("置き換え", "替换"),
    "Remove the landmarks that the two meshes have in common before those of the file are added": (
        "ファイルのランドマークを追加する前に、二つのメッシュに共通するランドマークを削除します",
        "在添加文件中的地标之前，先移除两个网格共有的地标",
    ),
    "Select Matched Point": ("対応点を選択", "选择匹配点"),
    "Select the vertices nearest to a matched point, and nothing else of the two meshes": (
        "二つのメッシュで、対応点に最も近い頂点だけを選択します",
        "选择离匹配点最近的顶点，两个网格上的其他内容均不选",
    ),
    "Which matched point; if zero, the one that is active in the list": (
        "どの対応点か。0ならリストでアクティブなもの",
        "哪个匹配点；为零时使用列表中的活动项",
    ),
    "Lock Matched Point": ("対応点をロック", "锁定匹配点"),
    (
        "Make a landmark of a matched point that is right, so that it stays where it is when the match is refined or "
        "made anew; once more lets it go"
    ): (
        "正しい対応点をランドマークにして、改良や再マッチングでも動かないようにします。もう一度実行すると解除します",
        "将正确的匹配点设为地标，使其在改善或重新匹配时保持不动；再执行一次则解除",
    ),
    "Remove Matched Point": ("対応点を削除", "移除匹配点"),
    "Remove the vertex groups of a matched point from both meshes; the dense map stays as it is": (
        "両方のメッシュから対応点の頂点グループを削除します。密なマップはそのままです",
        "从两个网格中移除匹配点的顶点组；稠密映射保持不变",
    ),
    "Refine": ("改良", "改善"),
    (
        "Make the match better around landmarks and locked points, in a fraction of the time of a match. What is wrong "
        "altogether, such as a leg on another leg, has to be matched again"
    ): (
        (
            "ランドマークとロックしたポイントの周りのマッチングを、マッチングのごく一部の時間で改良します。脚が別の脚に"
            "対応しているなど、全体として誤ったものは再マッチングが必要です"
        ),
        "在地标和锁定点周围改善匹配，用时远少于一次匹配。整体错误的部分，例如腿匹配到另一条腿，需要重新匹配",
    ),
    "Show": ("表示", "显示"),
    "Show the match in colors in this viewport, or show the meshes as before": (
        "このビューポートでマッチングを色で表示するか、メッシュを元の表示に戻します",
        "在此视图中用颜色显示匹配，或恢复网格原来的显示",
    ),
    "What to show": ("表示するもの", "显示什么"),
    "Nothing": ("なし", "无"),
    "Show the meshes as before": ("メッシュを元のように表示します", "按原来的样子显示网格"),
    "Show corresponding places in the same color": ("対応する場所を同じ色で表示します", "用相同颜色显示对应位置"),
    "Show how much lengths differ, from dark blue (none) to yellow": (
        "長さがどれだけ異なるかを、暗い青(差なし)から黄で表示します",
        "显示长度的差异，从深蓝（无差异）到黄色",
    ),
    "Show in blue what has a counterpart on the other mesh, and in grey what has none": (
        "もう一方のメッシュに対応する場所があるところを青、ないところをグレーで表示します",
        "用蓝色显示在另一个网格上有对应部分的地方，用灰色显示没有的地方",
    ),
    "Show how far the dense map can be trusted, from dark red to white (fully)": (
        "密なマップをどこまで信頼できるかを、暗い赤から白(完全に)で表示します",
        "显示稠密映射的可信程度，从深红到白色（完全可信）",
    ),
    "Regions": ("領域", "区域"),
    "Show each vertex in the color of the nearest matched point": (
        "各頂点を最も近い対応点の色で表示します",
        "用最近匹配点的颜色显示每个顶点",
    ),
    "Checker": ("チェッカー", "棋盘格"),
    "Show checks on the source, and where the dense map takes them on the target": (
        "ソースに市松模様を表示し、密なマップがそれをターゲットのどこに移すかを表示します",
        "在源上显示棋盘格，并显示稠密映射将其带到目标的何处",
    ),
    "Write Regions": ("領域を書き込み", "写入区域"),
    (
        "Write a vertex group for each matched point with all vertices that are nearer to it than to any other; groups "
        "of the same name are the same region"
    ): (
        (
            "対応点ごとに、ほかのどれよりもそれに近いすべての頂点を含む頂点グループを書き込みます。同じ名前のグループが"
            "同じ領域です"
        ),
        "为每个匹配点写入一个顶点组，包含离它比离其他点更近的所有顶点；同名的组就是同一区域",
    ),
    "Done": ("完了", "完成"),
    "What was carried over to which object, one per line": (
        "どのオブジェクトに何を転送したか。一行に一つです",
        "向哪个物体传递了什么，每行一项",
    ),
    "Remarks": ("情報", "说明"),
    "What was left out, or should be known, but is no reason to worry: one sentence per line": (
        "気にする必要のない、除外されたものや知っておくべきこと。一行に一文",
        "已排除或需要知道、但无需担心的内容：每行一句",
    ),
    "What was left out, or should be known, and why: one sentence per line": (
        "何が省かれたか、または知っておくべきことと、その理由。一行に一文です",
        "省略了什么或应了解什么，以及原因：每行一句",
    ),
    "How long it took": ("かかった時間", "所用时间"),
    "Source Number": ("ソースの番号", "源编号"),
    "By what number Blender knows the first object of the source": (
        "Blenderがソースの最初のオブジェクトを識別する番号",
        "Blender 识别源的第一个物体的编号",
    ),
    "Target Number": ("ターゲットの番号", "目标编号"),
    "By what number Blender knows the first object of the target": (
        "Blenderがターゲットの最初のオブジェクトを識別する番号",
        "Blender 识别目标的第一个物体的编号",
    ),
    "Session": ("セッション", "会话"),
    "In which session these numbers hold; in others, names are gone by": (
        "これらの番号が有効なセッション。ほかのセッションでは名前で探します",
        "这些编号有效的会话；在其他会话中按名称查找",
    ),
    "Refine with Rig": ("リグで改良", "用绑定改善"),
    "Accept Doubtful": ("疑わしくても書き込む", "接受可疑匹配"),
    (
        "Write the result also if the match is not to be trusted, with a confidence below 30 percent. In a window you "
        "are asked"
    ): (
        "マッチングが信頼できない（信頼度が30％未満の）場合にも結果を書き込みます。ウィンドウでは確認されます",
        "即使匹配不可信（置信度低于 30%）也写入结果。在窗口中会询问您",
    ),
    "How far the matches can be trusted, one sentence per line; empty if that is unknown": (
        "マッチングをどこまで信頼できるか。一行に一文。不明な場合は空",
        "各匹配的可信程度，每行一句；未知时为空",
    ),
    "Doubtful": ("疑わしい", "可疑"),
    "Whether one of the matches is not to be trusted": ("信頼できないマッチングがあるかどうか", "是否有不可信的匹配"),
    (
        "If the source has a rig, fit it into the target and make the map of the match better with it, once for each "
        "match. It takes some seconds, and weights, joints and shape keys gain much"
    ): (
        (
            "ソースにリグがあれば、それをターゲットに合わせ、マッチングのマップをそれによって改良します。マッチングごと"
            "に一度だけです。数秒かかりますが、ウェイト、関節、シェイプキーが大きく向上します"
        ),
        (
            "如果源有绑定，将其适配到目标中，并借此改善匹配的映射，每个匹配只做一次。需要几秒钟，权重、关节和形态键会显"
            "著改善"
        ),
    ),
    "Report": ("レポート", "报告"),
    "What became of the last transfer": ("最後の転送の結果", "上一次传递的结果"),
    "Reports": ("レポート一覧", "报告列表"),
    "What became of the last transfer of each panel, by the panel's identifier": (
        "各パネルの最後の転送の結果。パネルの識別子ごと",
        "各面板上一次传递的结果，按面板标识符",
    ),
    "Rig": ("リグ", "绑定"),
    (
        "Give the target a copy of the source's armature, fitted into its body, and bind it. Left out if the source "
        "has none"
    ): (
        "ソースのアーマチュアのコピーをターゲットの体に合わせて与え、バインドします。ソースになければ省かれます",
        "为目标添加适配其身体的源骨架副本并绑定。如果源没有骨架则省略",
    ),
    "Weights": ("ウェイト", "权重"),
    "Carry the source's vertex groups. Left out if it has none": (
        "ソースの頂点グループを転送します。なければ省かれます",
        "传递源的顶点组。如果没有则省略",
    ),
    "Shape Keys": ("シェイプキー", "形态键"),
    "Carry the source's shape keys. Left out if it has none": (
        "ソースのシェイプキーを転送します。なければ省かれます",
        "传递源的形态键。如果没有则省略",
    ),
    "UV Maps": ("UVマップ", "UV 贴图"),
    "Carry the source's UV maps. Left out if it has none": (
        "ソースのUVマップを転送します。なければ省かれます",
        "传递源的 UV 贴图。如果没有则省略",
    ),
    "Attributes": ("属性", "属性"),
    "Carry color attributes, custom attributes, materials and marked edges": (
        "カラー属性、カスタム属性、マテリアル、マークした辺を転送します",
        "传递颜色属性、自定义属性、材质和标记的边",
    ),
    "Existing Rig": ("既存のリグ", "已有绑定"),
    "What becomes of an armature that was made for the target before": (
        "以前ターゲットのために作ったアーマチュアの扱い",
        "以前为目标制作的骨架如何处理",
    ),
    "Update": ("更新", "更新"),
    "Move its joints; all else that was changed on it since stays": (
        "関節を動かします。それ以降に変更したほかのものはそのままです",
        "移动其关节；此后所做的其他更改保留",
    ),
    "Keep": ("維持", "维持"),
    "Leave it as it is, and make another one": ("そのままにして、別のものを作ります", "保持原样，另做一个"),
    "Replace Own Rig": ("自身のリグを置き換え", "替换自身的绑定"),
    (
        "If the target has a rig of its own already, switch its Armature modifiers off, and hide it if it moves "
        "nothing else; it is not deleted. Otherwise both move the target"
    ): (
        (
            "ターゲットに自身のリグがすでにある場合、そのアーマチュアモディファイアーをオフにし、ほかに動かすものがなけ"
            "れば隠します。削除はしません。オフにすると、両方がターゲットを動かします"
        ),
        "如果目标已有自己的绑定，则关闭其骨架修改器，若它不再驱动别的物体则将其隐藏，但不会删除。否则两者都会驱动目标",
    ),
    '"{0}" is no longer moved by its own armature "{1}", whose Armature modifiers are switched off.': (
        "「{0}」は自身のアーマチュア「{1}」ではもう動きません。そのアーマチュアモディファイアーはオフになっています。",
        "“{0}”不再受自身的骨架“{1}”驱动，其骨架修改器已关闭。",
    ),
    (
        '"{0}" had "{1}" posed. That pose was left out: the rest pose of its own armature counts. To keep the pose '
        "instead, undo, apply that Armature modifier, and fit the rig again."
    ): (
        (
            '"{0}"は"{1}"にポーズを付けていましたが、そのポーズは移されず、自身のアーマチュアのレストポーズが使われまし'
            "た。ポーズを残すには、元に戻してそのアーマチュアモディファイアーを適用し、もう一度リグを合わせてください。"
        ),
        (
            '"{0}" 使 "{1}" 摆出了姿态。该姿态被略去，以其自身骨架的静置姿态为准。若要保留该姿态，请撤销，应用该骨架修'
            "改器，然后重新适配绑定。"
        ),
    ),
    'What it wears is still moved by "{0}": {1}. Fit it again by Wear.': (
        '着ているものはまだ"{0}"で動きます: {1}。「着せる」でもう一度合わせてください。',
        '它所穿的仍由 "{0}" 带动：{1}。请用“穿戴”重新适配。',
    ),
    "Bind": ("バインド", "绑定网格"),
    "Same Rest Pose": ("同じレストポーズ", "同一静置姿态"),
    (
        "Whether to bring the target to the rest pose of the source, so that the source's actions play on it. How it "
        "stood is kept as an action"
    ): (
        (
            "ターゲットをソースのレストポーズにして、ソースのアクションがそのまま再生されるようにするかどうか。元の立ち"
            "方はアクションとして残ります"
        ),
        "是否将目标带到源的静置姿态，使源的动作可以在其上播放。它原来的姿势保存为一个动作",
    ),
    "If It Has Actions": ("アクションがあれば", "若源有动作"),
    "If the rig of the source has an action or strips of actions": (
        "ソースのリグにアクションまたはアクションストリップがある場合",
        "源的骨架带有动作或动作片段时",
    ),
    "Always": ("常に", "始终"),
    "Also for actions that are to come later": ("後から作るアクションのためにも", "也为以后才有的动作做准备"),
    "Never": ("しない", "从不"),
    "The pose that the target stands in becomes its rest pose": (
        "ターゲットの今のポーズがレストポーズになります",
        "目标当前的姿势成为其静置姿态",
    ),
    "Rest Pose": ("レストポーズ", "静置姿态"),
    "a rest pose like the source's": ("ソースと同じレストポーズ", "与源相同的静置姿态"),
    (
        '"{0}" has the rest pose of "{1}" now, in which the actions of "{2}" play. How it stood is kept as the action '
        '"{3}".'
    ): (
        (
            "「{0}」は「{1}」のレストポーズになり、「{2}」のアクションが再生できます。元の立ち方はアクション「{3}」に残"
            "してあります。"
        ),
        "“{0}”现在处于“{1}”的静置姿态，“{2}”的动作可以在其上播放。它原来的姿势保存为动作“{3}”。",
    ),
    'What "{0}" wears stands as before: {1}. Fit it again by Wear.': (
        '"{0}"が着ているものは元の立ち方のままです: {1}。「着せる」でもう一度合わせてください。',
        '"{0}" 所穿的仍是原来的姿势：{1}。请用“穿戴”重新适配。',
    ),
    "The rest pose stays as it was, and the source's actions do not play as they should: {0}.": (
        "レストポーズは元のままで、ソースのアクションは正しく再生されません。理由：{0}。",
        "静置姿态保持原样，源的动作无法正确播放：{0}。",
    ),
    '"{0}" is moved by the armature "{1}" as well': (
        "「{0}」はアーマチュア「{1}」にも動かされています",
        "“{0}”还受骨架“{1}”驱动",
    ),
    '"{0}" has no weights for the bones of "{1}"': (
        "「{0}」には「{1}」のボーンのウェイトがありません",
        "“{0}”没有“{1}”各骨骼的权重",
    ),
    '"{0}" shares its mesh data with other objects': (
        "「{0}」はメッシュデータを他のオブジェクトと共有しています",
        "“{0}”与其他物体共用网格数据",
    ),
    (
        "Give the target an Armature modifier, set as the source's, and the armature as its parent if the source has "
        "its own as parent"
    ): (
        (
            "ソースと同じ設定のアーマチュアモディファイアーをターゲットに付け、ソースが自分のアーマチュアを親にしていれ"
            "ば、ターゲットもアーマチュアを親にします"
        ),
        "为目标添加与源设置相同的骨架修改器；如果源以自己的骨架为父级，则目标也以骨架为父级",
    ),
    "Also Rest Pose": ("レストポーズも", "同时制作静置姿态"),
    "If the target is in another pose than the source, make an action that takes it to a rest pose like the source's": (
        "ターゲットがソースと違うポーズなら、ソースと同様のレストポーズに戻すアクションを作ります",
        "如果目标与源姿态不同，制作一个动作，使其回到与源相同的静置姿态",
    ),
    "Show Rest Pose": ("レストポーズを表示", "显示静置姿态"),
    "Let the new armature take that rest pose at once": (
        "新しいアーマチュアをすぐにそのレストポーズにします",
        "让新骨架立即处于该静置姿态",
    ),
    "Pose": ("ポーズ", "姿态"),
    "Whether the target is in another pose than the source, for the rest pose": (
        "レストポーズのために、ターゲットがソースと違うポーズかどうか",
        "为确定静置姿态，目标是否与源处于不同姿态",
    ),
    "Automatic": ("自動", "自动"),
    "It is, if a large limb is bent much against the source": (
        "大きな手足がソースに対して大きく曲がっていれば、違うとみなします",
        "如果某个大的肢体相对源明显弯曲，则视为不同",
    ),
    "Posed": ("ポーズあり", "已摆姿态"),
    "It is: undo all rotations of its bones": (
        "違うポーズです。すべてのボーンの回転を取り消します",
        "是：撤销其骨骼的所有旋转",
    ),
    "At Rest": ("レスト状態", "处于静置"),
    "It is in its rest pose already, and only its build is different": (
        "すでにレストポーズで、体格だけが異なります",
        "它已处于静置姿态，只是体型不同",
    ),
    "Which vertex groups of the source are carried over. Those that a match wrote never are": (
        "ソースのどの頂点グループを転送するか。マッチングが書き込んだものは転送しません",
        "传递源的哪些顶点组。匹配写入的顶点组从不传递",
    ),
    "All": ("すべて", "全部"),
    "All vertex groups": ("すべての頂点グループ", "所有顶点组"),
    "Deforming Bones": ("変形ボーン", "形变骨骼"),
    "The vertex groups of bones that deform": ("変形するボーンの頂点グループ", "参与形变的骨骼的顶点组"),
    "Selected Bones": ("選択したボーン", "选中的骨骼"),
    "The vertex groups of the bones that are selected in the source's rig": (
        "ソースのリグで選択しているボーンの頂点グループ",
        "源绑定中选中骨骼的顶点组",
    ),
    "Active": ("アクティブ", "活动项"),
    "The active vertex group": ("アクティブな頂点グループ", "活动顶点组"),
    "Mode": ("モード", "模式"),
    "What becomes of the weights that the target has in these groups": (
        "これらのグループでターゲットが持つウェイトの扱い",
        "目标在这些组中已有的权重如何处理",
    ),
    "The carried weights take their place": ("転送したウェイトで置き換えます", "由传递来的权重取代"),
    "Add": ("加算", "相加"),
    "The carried weights are added to them": ("転送したウェイトを加えます", "将传递来的权重与之相加"),
    "Mix Factor": ("ミックス係数", "混合系数"),
    "How much the carried weights count against those that are there": (
        "既存のウェイトに対して転送したウェイトをどれだけ重視するか",
        "传递来的权重相对已有权重占多大比重",
    ),
    "Normalize": ("正規化", "规格化"),
    (
        "Let the weights of all bones sum to one at each vertex. Locked groups keep theirs. If only some groups are "
        "carried, the others of the target give way to them"
    ): (
        (
            "各頂点ですべてのボーンのウェイトの合計を1にします。ロックしたグループは変わりません。一部のグループだけを"
            "転送する場合は、ターゲットのほかのグループが譲ります"
        ),
        "使每个顶点处所有骨骼的权重之和为一。锁定的组保持不变。如果只传递部分组，目标的其他组会让出权重",
    ),
    "Limit": ("制限", "限制"),
    "How many bones may move a vertex: the smallest weights go, and fade before they do. 0 for any number": (
        "一つの頂点を動かせるボーンの数。最小のウェイトから、しだいに弱めて除かれます。0で無制限",
        "最多多少个骨骼可以带动一个顶点：最小的权重会逐渐减弱后去除。0 表示不限",
    ),
    "Clean": ("クリーン", "清理"),
    "Weights below this are dropped, but for the largest of each vertex": (
        "これより小さいウェイトは、各頂点の最大のものを除いて削除されます",
        "低于此值的权重会被丢弃，但每个顶点最大的权重除外",
    ),
    "Fill": ("フィル", "填充"),
    "Where the map tears vertices away from their neighbors, take the weights from around them along the surface": (
        "マップが頂点を隣から引き離した場所では、表面に沿って周囲のウェイトを使います",
        "在映射将顶点与相邻顶点撕开之处，沿表面取用周围的权重",
    ),
    "Rigid Pieces": ("剛体の部品", "刚性部件"),
    (
        "Let loose pieces move as one, such as eyes, teeth, buckles and plates, if what they correspond to does on the "
        "source"
    ): (
        "目、歯、バックル、装甲板のような独立した部品を、ソースの対応する部分がそうなら一体として動くようにします",
        "眼睛、牙齿、扣环、甲片之类的松散部件，若其在源上的对应部分整体移动，则也整体移动",
    ),
    "Rigid Group": ("剛体グループ", "刚性组"),
    (
        "Vertex group of the target for single pieces: a loose piece with vertices of weight 1 in it moves by one "
        "bone, one with vertices of weight 0 never moves as one, whatever the source does"
    ): (
        (
            "個々の部品を指定するターゲットの頂点グループ。ウェイト1の頂点がある独立部品は一つのボーンで動き、ウェイト0"
            "の頂点がある部品は、ソースにかかわらず一体としては動きません"
        ),
        (
            "目标上用于指定单个部件的顶点组：组中有权重为 1 的顶点的松散部件由一根骨骼驱动，有权重为 0 的顶点的部件从不"
            "整体移动，不论源如何"
        ),
    ),
    "No Counterpart": ("対応のない場所", "没有对应部分处"),
    "Follow the Map": ("マップに従う", "遵循映射"),
    (
        "What vertices get that have no counterpart on the source, as Show > Overlap tells: where the target shows "
        "more of a body than the source"
    ): (
        (
            "ソースに対応する場所がない頂点（「表示 > 重なり」でわかります）をどうするか。ターゲットがソースより体の多"
            "くの部分を含む場合に使います"
        ),
        "在源上没有对应部分的顶点得到什么，重叠视图会显示它们：用于目标比源显示了身体更多部分之处",
    ),
    "The weights of the nearest place that the map leads to": (
        "マップが指す最も近い場所のウェイト",
        "映射所指最近处的权重",
    ),
    "The weights of the vertices around them that have a counterpart": (
        "周囲の、対応のある頂点のウェイト",
        "其周围有对应部分的顶点的权重",
    ),
    "Their weights stay as they are": ("ウェイトはそのまま", "其权重保持不变"),
    "Mark Rejected": ("除外をマーク", "标记被弃用处"),
    (
        "Write a color attribute that shows in red which vertices were torn away from their neighbors, so that their "
        "own weights were rejected"
    ): (
        "隣から引き離され、自身のウェイトが使われなかった頂点を赤で示すカラー属性を書き込みます",
        "写入一个颜色属性，用红色显示哪些顶点与相邻顶点撕开，因而其自身权重被弃用",
    ),
    "Which shape keys of the source are carried over": ("ソースのどのシェイプキーを転送するか", "传递源的哪些形态键"),
    "All shape keys": ("すべてのシェイプキー", "所有形态键"),
    "The active shape key": ("アクティブなシェイプキー", "活动形态键"),
    "By Name": ("名前", "按名称"),
    "The shape keys that are named": ("名前を指定したシェイプキー", "指定名称的形态键"),
    "Names": ("名前", "名称"),
    "Names of the shape keys to carry over, separated by commas": (
        "転送するシェイプキーの名前。コンマで区切ります",
        "要传递的形态键名称，用逗号分隔",
    ),
    "Existing Keys": ("既存のキー", "已有的键"),
    "What becomes of shape keys of the same name that the target has already": (
        "ターゲットがすでに持つ同名のシェイプキーの扱い",
        "目标已有的同名形态键如何处理",
    ),
    "Give them the new shape and settings": ("新しい形状と設定を与えます", "赋予它们新的形状和设置"),
    "Skip": ("スキップ", "跳过"),
    "Leave them as they are": ("そのまま残します", "保持原样"),
    "Scale": ("スケール", "缩放"),
    "What becomes of the size of the movements": ("動きの大きさの扱い", "移动幅度如何处理"),
    "With Size if the target is clearly larger or smaller than the source, else only to its units": (
        "ターゲットがソースより明らかに大きいか小さければ「サイズに合わせる」、そうでなければ単位だけを合わせる",
        "如果目标明显大于或小于源，则为“随大小”，否则只换算单位",
    ),
    "None": ("なし", "无"),
    "As long as on the source": ("ソースと同じ長さ", "与源上一样长"),
    "With Size": ("サイズに合わせる", "随大小"),
    "Longer or shorter as the whole target is larger or smaller": (
        "ターゲット全体の大きさに応じて長くまたは短くします",
        "随整个目标的大小变长或变短",
    ),
    "Locally": ("局所的", "局部"),
    "Longer or shorter as the target is larger or smaller around each place": (
        "各場所の周りのターゲットの大きさに応じて長くまたは短くします",
        "随目标在各处周围的大小变长或变短",
    ),
    "Threshold": ("しきい値", "阈值"),
    (
        "Movements shorter than this part of the longest of a shape key are dropped, so that vertices far from what it "
        "moves stay exactly in place"
    ): (
        (
            "シェイプキーの最長の動きに対してこの割合より短い動きは捨てられ、動く場所から遠い頂点は正確にその場に留まり"
            "ます"
        ),
        "短于形态键最长移动此比例的移动会被丢弃，使远离移动部位的顶点精确保持原位",
    ),
    "Drivers": ("ドライバー", "驱动器"),
    (
        "Copy the drivers of the shape keys. Where they point to the source or its armature, the copies point to the "
        "target and its armature"
    ): (
        (
            "シェイプキーのドライバーをコピーします。ソースまたはそのアーマチュアを参照している箇所は、ターゲットとその"
            "アーマチュアを参照します"
        ),
        "复制形态键的驱动器。其中指向源或其骨架之处，在副本中指向目标及其骨架",
    ),
    "Action": ("アクション", "动作"),
    "Let the target's shape keys play the action of the source's, unless they have one of their own. Both share it": (
        (
            "ターゲットのシェイプキーに独自のアクションがなければ、ソースのシェイプキーのアクションで動かします。アクシ"
            "ョンは両者で共有されます"
        ),
        "若目标的形态键没有自己的动作，则播放源的形态键的动作。两者共用该动作",
    ),
    "Which UV maps of the source are carried over. Those of the same name are replaced": (
        "ソースのどのUVマップを転送するか。同名のものは置き換えられます",
        "传递源的哪些 UV 贴图。同名的会被替换",
    ),
    "All UV maps": ("すべてのUVマップ", "所有 UV 贴图"),
    "The active UV map": ("アクティブなUVマップ", "活动 UV 贴图"),
    "The UV maps that are named": ("名前を指定したUVマップ", "指定名称的 UV 贴图"),
    "Names of the UV maps to carry over, separated by commas": (
        "転送するUVマップの名前。コンマで区切ります",
        "要传递的 UV 贴图名称，用逗号分隔",
    ),
    "Mark Seams": ("シームをマーク", "标记为缝合边"),
    (
        "Mark the edges between the islands of the active UV map as seams on the target, instead of the seams that it "
        "has"
    ): (
        "ターゲットの既存のシームの代わりに、アクティブなUVマップのアイランドの境界の辺をシームとしてマークします",
        "将活动 UV 贴图各孤岛之间的边标记为目标的缝合边，取代其原有的缝合边",
    ),
    "Color Attributes": ("カラー属性", "颜色属性"),
    "Carry color attributes over; those of the same name are replaced": (
        "カラー属性を転送します。同名のものは置き換えられます",
        "传递颜色属性；同名的会被替换",
    ),
    "Other Attributes": ("その他の属性", "其他属性"),
    "Carry over attributes of numbers, vectors and truth values that were added to the source": (
        "ソースに追加された数値、ベクトル、ブール値の属性を転送します",
        "传递添加到源上的数值、矢量和布尔值属性",
    ),
    "Names of the attributes to carry over, separated by commas; if empty, all": (
        "転送する属性の名前。コンマで区切ります。空ならすべて",
        "要传递的属性名称，用逗号分隔；为空时传递全部",
    ),
    "Materials": ("マテリアル", "材质"),
    (
        "Give each face the material of the source there; materials are added to the slots of the target unless they "
        "are there already"
    ): (
        "各面にソースのその場所のマテリアルを与えます。まだなければターゲットのスロットに追加されます",
        "赋予每个面源在该处的材质；材质会添加到目标的材质槽，除非已存在",
    ),
    "Sharp Edges": ("シャープな辺", "锐边"),
    (
        "Mark the edges as sharp that follow sharp edges of the source, and shade faces flat where the source is, "
        "instead of what is marked on the target"
    ): (
        (
            "ターゲットの既存のマークの代わりに、ソースのシャープ辺に沿う辺をシャープにし、ソースがフラットな場所の面を"
            "フラットにします"
        ),
        "将沿着源锐边的边标记为锐边，并在源为平直着色之处将面设为平直着色，取代目标原有的标记",
    ),
    "Seams": ("シーム", "缝合边"),
    (
        "Mark the edges as seams that follow seams of the source, instead of those of the target. UV maps that are "
        "carried over bring their own"
    ): (
        (
            "ターゲットのシームの代わりに、ソースのシームに沿う辺をシームとしてマークします。転送されるUVマップは独自の"
            "シームを伴います"
        ),
        "将沿着源缝合边的边标记为缝合边，取代目标的缝合边。传递的 UV 贴图自带其缝合边",
    ),
    "Creases and Bevels": ("クリースとベベル", "折痕与倒角权重"),
    "Carry creases and bevel weights over to the edges and vertices that follow those of the source": (
        "クリースとベベルウェイトを、ソースのものに沿う辺と頂点に転送します",
        "将折痕和倒角权重传递到沿着源的边和顶点上",
    ),
    "Custom Normals": ("カスタム法線", "自定义法向"),
    "Carry over how the custom normals of the source deviate from its surface, if it has any": (
        "ソースにカスタム法線があれば、その表面からのずれを転送します",
        "如果源有自定义法向，传递其相对表面的偏离",
    ),
    "Wrap": ("ラップ", "包裹"),
    "Whose surface is laid onto the other": ("どちらの表面をもう一方に重ねるか", "将哪一方的表面贴到另一方"),
    "Source to Target": ("ソースをターゲットへ", "源到目标"),
    "Lay the source onto the target": ("ソースをターゲットに重ねます", "将源贴到目标上"),
    "Target to Source": ("ターゲットをソースへ", "目标到源"),
    "Lay the target onto the source": ("ターゲットをソースに重ねます", "将目标贴到源上"),
    "Result": ("結果", "结果"),
    "What is made": ("作成するもの", "生成什么"),
    "Shape Key": ("シェイプキー", "形态键"),
    "Add a shape key to the mesh: its slider leads from one shape to the other": (
        "メッシュにシェイプキーを追加します。スライダーで一方の形からもう一方へ変化します",
        "为网格添加一个形态键：其滑块从一个形状过渡到另一个",
    ),
    "New Object": ("新規オブジェクト", "新建物体"),
    "Make a new object that has both shapes, and leave the mesh as it is": (
        "両方の形を持つ新しいオブジェクトを作り、メッシュはそのままにします",
        "新建一个具有两种形状的物体，网格保持不变",
    ),
    "Place": ("位置", "位置"),
    "Where the wrapped shape stands": ("ラップした形状を置く場所", "包裹后的形状所处的位置"),
    "At the Other": ("相手の位置", "另一方处"),
    "Where the mesh stands that it is laid onto": ("重ねる相手のメッシュの場所", "所贴合的网格所在之处"),
    "Own Place": ("自身の位置", "自身位置"),
    "Where the mesh stood, turned and moved back as one": (
        "メッシュがあった場所。全体を一つとして回転、移動して戻します",
        "网格原来所在之处，整体旋转并移回",
    ),
    "In-Betweens": ("中間形状", "中间形态"),
    (
        "How many shape keys are added that keep limbs from shrinking on the way. They follow the slider of the first "
        "by drivers"
    ): (
        "途中で手足が縮まないように追加するシェイプキーの数。ドライバーによって最初のキーのスライダーに従います",
        "添加多少个形态键以防肢体在过渡中收缩。它们通过驱动器跟随第一个键的滑块",
    ),
    "Direction": ("方向", "方向"),
    (
        "Which side is taken to the other. The sides are told apart by vertex groups with names such as Arm.L and "
        "Arm.R, or else by the object's X axis, which points to the left"
    ): (
        (
            "どちらの側を反対側に写すか。左右はArm.LとArm.Rのような名前の頂点グループ、なければ左を指すオブジェクトのX"
            "軸で区別します"
        ),
        "将哪一侧复制到另一侧。两侧依据 Arm.L 和 Arm.R 之类名称的顶点组区分，否则依据指向左侧的物体 X 轴区分",
    ),
    "Left to Right": ("左から右", "从左到右"),
    "The left side is good": ("左側が正しい", "左侧是正确的"),
    "Right to Left": ("右から左", "从右到左"),
    "The right side is good": ("右側が正しい", "右侧是正确的"),
    "Make the weights of vertex groups symmetric; locked groups are left alone": (
        "頂点グループのウェイトを対称にします。ロックしたグループはそのままです",
        "使顶点组的权重对称；锁定的组保持不变",
    ),
    "Make shape keys symmetric": ("シェイプキーを対称にします", "使形态键对称"),
    "Colors": ("色", "颜色"),
    "Make color attributes symmetric": ("カラー属性を対称にします", "使颜色属性对称"),
    "Create Missing Sides": ("欠けた側を作成", "创建缺失的一侧"),
    "Add vertex groups and shape keys of the other side where only one side is there": (
        "片側しかない場合に、反対側の頂点グループとシェイプキーを追加します",
        "在只有一侧之处，添加另一侧的顶点组和形态键",
    ),
    "Retarget": ("リターゲット", "重定向"),
    (
        "Match the source with the target if that has not been done, and carry its rig, weights, shape keys and UV "
        "maps over, whatever the pose, build and topology of the target"
    ): (
        (
            "まだならソースとターゲットをマッチングし、ターゲットのポーズ、体格、トポロジーを問わず、リグ、ウェイト、シ"
            "ェイプキー、UVマップを転送します"
        ),
        "必要时先匹配源与目标，再传递其绑定、权重、形态键和 UV 贴图，无论目标的姿态、体型和拓扑如何",
    ),
    "Name of the object to carry to; if empty, the one picked in the panel or else all other selected meshes": (
        "転送先のオブジェクトの名前。空ならパネルで選んだもの、なければほかの選択中のすべてのメッシュ",
        "传递去向的物体名称；为空时使用面板中选取的物体，否则使用所有其他选中的网格",
    ),
    "Targets": ("ターゲット", "目标"),
    "Names of several objects to carry to": ("複数の転送先のオブジェクトの名前", "传递去向的多个物体的名称"),
    "What the names start with that the match to use wrote; if empty, the one match that the objects carry": (
        "使用するマッチングが書き込んだ名前の先頭。空ならオブジェクトが持つ唯一のマッチング",
        "所用匹配写入的名称的开头；为空时使用物体所带的唯一匹配",
    ),
    "Fit Rig": ("リグをフィット", "适配绑定"),
    (
        "Give the matched meshes a copy of the source's armature each, with its joints where they belong in their pose "
        "and build, and bind them to it"
    ): (
        (
            "マッチングしたメッシュそれぞれにソースのアーマチュアのコピーを与え、そのポーズと体格に合った位置に関節を置"
            "き、バインドします"
        ),
        "为每个已匹配的网格添加源骨架的副本，使关节位于其姿态和体型应有的位置，并绑定",
    ),
    "Transfer Weights": ("ウェイトを転送", "传递权重"),
    "Carry the source's vertex groups to the matched meshes, whatever their pose and topology": (
        "ポーズやトポロジーを問わず、ソースの頂点グループをマッチングしたメッシュに転送します",
        "将源的顶点组传递到已匹配的网格，无论其姿态和拓扑如何",
    ),
    "Transfer Shape Keys": ("シェイプキーを転送", "传递形态键"),
    (
        "Carry the source's shape keys to the matched meshes, whatever their pose and topology, with their values, "
        "ranges and drivers"
    ): (
        (
            "ポーズやトポロジーを問わず、ソースのシェイプキーを値、範囲、ドライバーとともにマッチングしたメッシュに転送"
            "します"
        ),
        "将源的形态键连同其值、范围和驱动器传递到已匹配的网格，无论其姿态和拓扑如何",
    ),
    "Transfer UVs": ("UVを転送", "传递 UV"),
    (
        "Carry the source's UV maps to the matched meshes, whatever their pose and topology, so that its textures fit "
        "them. Islands stay islands: no face is smeared across a seam"
    ): (
        (
            "ポーズやトポロジーを問わず、ソースのUVマップをマッチングしたメッシュに転送し、テクスチャが合うようにします"
            "。アイランドは保たれ、シームをまたいで引き伸ばされる面はありません"
        ),
        "将源的 UV 贴图传递到已匹配的网格，无论其姿态和拓扑如何，使纹理与之吻合。孤岛保持为孤岛：没有面跨缝合边被拉伸",
    ),
    "Transfer Attributes": ("属性を転送", "传递属性"),
    (
        "Carry color and other attributes, materials, sharp edges, creases and custom normals of the source to the "
        "matched meshes, whatever their pose and topology"
    ): (
        (
            "ポーズやトポロジーを問わず、ソースのカラー属性などの属性、マテリアル、シャープ辺、クリース、カスタム法線を"
            "マッチングしたメッシュに転送します"
        ),
        "将源的颜色及其他属性、材质、锐边、折痕和自定义法向传递到已匹配的网格，无论其姿态和拓扑如何",
    ),
    (
        "Lay the source onto the matched mesh, as a shape key whose slider morphs one into the other. Parts that the "
        "other mesh lacks follow their surroundings"
    ): (
        (
            "マッチングしたメッシュにソースを重ね、スライダーで一方からもう一方へモーフするシェイプキーにします。相手に"
            "ない部分は周囲に従います"
        ),
        "将源贴到已匹配的网格上，成为一个形态键，其滑块使一方变形为另一方。另一网格所缺的部分跟随其周围",
    ),
    "Turn": ("回転", "旋转"),
    "How the target's surface is turned against the source's at rest, in the spaces of the armatures": (
        "レスト時にターゲットの表面がソースに対してどれだけ回転しているか。アーマチュアの空間での値です",
        "静置时目标表面相对于源表面的旋转，以骨架各自的空间表示",
    ),
    "Source Bone": ("ソースのボーン", "源骨骼"),
    "Bone of the source; empty for none": ("ソースのボーン。ない場合は空にします", "源的骨骼；没有则为空"),
    "Target Bone": ("ターゲットのボーン", "目标骨骼"),
    "Bone of the target that stands for it": ("それに対応するターゲットのボーン", "与之对应的目标骨骼"),
    "Where the head of the source bone lies in the target, in the target armature's space": (
        "ソースのボーンのヘッドがターゲットのどこにあるか。ターゲットのアーマチュアの空間での値です",
        "源骨骼头端在目标中的位置，以目标骨架的空间表示",
    ),
    "Lock": ("ロック", "锁定"),
    "Keep this row when bones are paired again; without a source, the bone stays alone": (
        "ボーンを再びペアにするときこの行を保ちます。ソースがなければ、そのボーンは単独のままです",
        "再次配对骨骼时保留此行；没有源时，该骨骼保持单独",
    ),
    "Standing": ("立ち方", "站立"),
    "How the target stands, turned against the source, in the spaces of the armatures": (
        "ターゲット全体がソースに対してどれだけ回転して立っているか。アーマチュアの空間での値です",
        "目标整体相对于源的旋转，以骨架各自的空间表示",
    ),
    "Source Rig": ("ソースのリグ", "源绑定"),
    "Armature of the source": ("ソースのアーマチュア", "源的骨架"),
    "Target Rig": ("ターゲットのリグ", "目标绑定"),
    "Armature of the target": ("ターゲットのアーマチュア", "目标的骨架"),
    "Score": ("スコア", "得分"),
    "How well the two agree, from 0 to 1": ("二つがどれだけ一致するか。0から1", "两者的吻合程度，0 到 1"),
    "Source Bone at Rest": ("ソースボーンのレスト位置", "源骨骼的静置位置"),
    "Head, tail and a point beside the head of the source bone when turn and place were seen": (
        "向きと位置を確認したときの、ソースボーンのヘッド、テール、ヘッドの横の点",
        "确认旋转和位置时源骨骼的头端、尾端以及头端旁的一点",
    ),
    "Target Bone at Rest": ("ターゲットボーンのレスト位置", "目标骨骼的静置位置"),
    "Head, tail and a point beside the head of the target bone when turn and place were seen": (
        "向きと位置を確認したときの、ターゲットボーンのヘッド、テール、ヘッドの横の点",
        "确认旋转和位置时目标骨骼的头端、尾端以及头端旁的一点",
    ),
    "Seen": ("表面で確認", "已在表面确认"),
    "Whether turn and place were seen on the surface; a row made by hand has none": (
        "回転と位置が表面から求められたかどうか。手で作った行にはありません",
        "旋转和位置是否由表面得出；手动建立的行没有",
    ),
    "Pair": ("ペア", "配对"),
    "The row of the table of bones that is active": ("ボーンの表でアクティブな行", "骨骼表中的活动行"),
    "Tolerance": ("許容誤差", "容差"),
    "By how much reduced keys may change a rotation": (
        "キーの削減で回転がどれだけ変わってよいか",
        "精简关键帧时旋转允许改变的量",
    ),
    "Actions": ("対象アクション", "动作范围"),
    "Which actions of the source are carried over": ("ソースのどのアクションを移すか", "传递源的哪些动作"),
    "The one that the source plays, or the only one that it has": (
        "ソースが再生しているもの、または唯一のもの",
        "源正在播放的动作，或其唯一的动作",
    ),
    "All actions of the file that move bones of the source": (
        "ソースのボーンを動かす、ファイル内のすべてのアクション",
        "文件中所有移动源骨骼的动作",
    ),
    "Keys": ("キー", "关键帧"),
    "At which frames the new action gets keys": (
        "新しいアクションがどのフレームにキーを持つか",
        "新动作在哪些帧上有关键帧",
    ),
    "At the source's keys if these are few, else reduced ones": (
        "ソースのキーが少なければその位置に、多ければ削減したキー",
        "源的关键帧较少时与之相同，否则为精简的关键帧",
    ),
    "As the Source": ("ソースと同じ", "与源相同"),
    "At the keys of the source's bones, with their interpolation": (
        "ソースのボーンのキーの位置に、その補間で",
        "在源骨骼的关键帧处，并采用其插值",
    ),
    "Reduced": ("削減", "精简"),
    "As few as keep the motion within the Tolerance": (
        "モーションを許容誤差内に保つ最少のキー",
        "使运动保持在容差内的最少关键帧",
    ),
    "Every Frame": ("全フレーム", "每一帧"),
    "At every frame": ("すべてのフレームに", "在每一帧上"),
    "Stride": ("歩幅", "步幅"),
    "How long the way along the ground is; 1 fits the length of the target's legs": (
        "地面に沿った移動の長さ。1でターゲットの脚の長さに合います",
        "沿地面移动的距离；1 与目标的腿长相称",
    ),
    "In Place": ("その場で", "原地"),
    "Take out the way from the first to the last frame, for walk cycles": (
        "最初から最後のフレームまでの移動を取り除きます。歩行サイクル用です",
        "去除从第一帧到最后一帧的移动，用于行走循环",
    ),
    "Feet on Ground": ("足を地面に保つ", "脚保持着地"),
    (
        "Where a foot stands in the source, let it stand in the target: the leg is bent for it. All frames are "
        "computed then"
    ): (
        "ソースで足が立っているところでは、ターゲットの足も動かないように脚を曲げます。全フレームが計算されます",
        "源的脚站立之处，目标的脚也站立不动：为此弯曲腿部。此时会计算所有帧",
    ),
    "Hands on Body": ("手を体に保つ", "手保持贴身"),
    (
        "Where a hand touches the body or the other hand in the source, bend the target's arm so that it does so too. "
        "All frames are computed then"
    ): (
        (
            "ソースで手が体や反対の手に触れているところでは、ターゲットの手も触れるように腕を曲げます。全フレームが計算"
            "されます"
        ),
        "源的手触及身体或另一只手之处，弯曲目标的手臂使其同样触及。此时会计算所有帧",
    ),
    "Pair Bones": ("ボーンをペアにする", "配对骨骼"),
    (
        "Find out which bones of two rigs belong together by the surface that they move, whatever they are called. The "
        "bodies are matched first if that has not been done"
    ): (
        (
            "二つのリグのどのボーンが対応するかを、名前に関係なく、動かす表面から求めます。体がまだマッチングされていな"
            "ければ先に行います"
        ),
        "根据骨骼所带动的表面找出两套绑定中相互对应的骨骼，与名称无关。若身体尚未匹配，会先进行匹配",
    ),
    "Retarget Action": ("アクションをリターゲット", "重定向动作"),
    (
        "Carry actions of the source's armature to others, whatever their bones are called, how many there are, and "
        "how they rest. Bones are paired first if that has not been done"
    ): (
        (
            "ソースのアーマチュアのアクションを、ボーンの名前や数やレストポーズに関係なく、他のアーマチュアに移します。"
            "ボーンがまだペアになっていなければ先に行います"
        ),
        "将源骨架的动作传递到其他骨架，无论骨骼的名称、数量和静置姿态如何。若骨骼尚未配对，会先进行配对",
    ),
    (
        "Name of the action to carry over, or a pattern such as Walk*; several with a semicolon between them. If "
        "empty, those that Actions says"
    ): (
        (
            "引き継ぐアクションの名前、または Walk* のようなパターン。複数ならセミコロンで区切ります。空なら「アクショ"
            "ン」の指すもの"
        ),
        "要传递的动作的名称，或如 Walk* 的模式；多个之间用分号隔开。若为空，则为“动作”所指的",
    ),
    "NLA Strips": ("NLAストリップ", "NLA 片段"),
    "Carry the actions of the source's NLA strips over as well, and copy the strips": (
        "ソースのNLAストリップのアクションも移し、ストリップをコピーします",
        "同时传递源的 NLA 片段的动作，并复制这些片段",
    ),
    "Play": ("再生", "播放"),
    "Let the target play the new action, if it is one only": (
        "新しいアクションが一つだけなら、ターゲットに再生させます",
        "如果只有一个新动作，让目标播放它",
    ),
    "Retarget Pose": ("ポーズをリターゲット", "重定向姿态"),
    "Pose other armatures as the source's stands now. Bones are paired first if that has not been done": (
        "他のアーマチュアをソースの現在のポーズにします。ボーンがまだペアになっていなければ先に行います",
        "使其他骨架摆出源骨架当前的姿态。若骨骼尚未配对，会先进行配对",
    ),
    "Where a hand touches the body or the other hand in the source, bend the target's arm so that it does so too": (
        "ソースで手が体や反対の手に触れているところでは、ターゲットの手も触れるように腕を曲げます",
        "源的手触及身体或另一只手之处，弯曲目标的手臂使其同样触及",
    ),
    "Add Bone Pair": ("ボーンのペアを追加", "添加骨骼配对"),
    "Pair two bones by hand, and lock the pair; without a source bone, the target's bone stays alone": (
        "二つのボーンを手でペアにしてロックします。ソースのボーンがなければ、ターゲットのボーンは単独のままです",
        "手动配对两个骨骼并锁定；没有源骨骼时，目标骨骼保持单独",
    ),
    "Bone of the target; if empty, the active bones of both armatures are paired": (
        "ターゲットのボーン。空なら、両方のアーマチュアのアクティブなボーンをペアにします",
        "目标的骨骼；若为空，则将两个骨架的活动骨骼配对",
    ),
    "Remove Bone Pair": ("ボーンのペアを削除", "移除骨骼配对"),
    "Take a pair of bones out of the table": ("ボーンのペアを表から取り除きます", "将一对骨骼从表中移除"),
    "Remove its pair with this bone only; if empty, all": (
        "このボーンとのペアだけを削除します。空ならすべて",
        "只移除与此骨骼的配对；若为空，则全部移除",
    ),
    "Bone of the target whose pairs are removed": ("ペアを削除するターゲットのボーン", "要移除其配对的目标骨骼"),
    "Clear Bone Pairs": ("ボーンのペアを消去", "清除骨骼配对"),
    "Take the pairs of two armatures out of the table": (
        "二つのアーマチュアのペアを表から取り除きます",
        "将两个骨架的配对从表中移除",
    ),
    "Locked Too": ("ロックも含む", "包括锁定的"),
    "Take locked pairs out as well": ("ロックされたペアも取り除きます", "也移除锁定的配对"),
    "Export Bone Pairs": ("ボーンのペアを書き出し", "导出骨骼配对"),
    "Save the pairs of bones of two armatures to a file, for other files with the same rigs": (
        "二つのアーマチュアのボーンのペアをファイルに保存します。同じリグを使う他のファイルのためです",
        "将两个骨架的骨骼配对保存到文件，供使用相同绑定的其他文件使用",
    ),
    "Import Bone Pairs": ("ボーンのペアを読み込み", "导入骨骼配对"),
    "Load pairs of bones from a file in place of those of two armatures": (
        "二つのアーマチュアのペアの代わりに、ファイルからボーンのペアを読み込みます",
        "从文件加载骨骼配对，取代两个骨架现有的配对",
    ),
    "Weights to Own Rig": ("自身のリグへのウェイト", "权重到自身绑定"),
    (
        "Carry the source's weights to the bones that the target has already, through the pairs of bones: they are "
        "shared out where it has more bones, and added up where it has fewer"
    ): (
        (
            "ソースのウェイトを、ボーンのペアを通じて、ターゲットがすでに持つボーンに移します。ボーンが多いところでは分"
            "配し、少ないところでは合計します"
        ),
        "通过骨骼配对将源的权重传递到目标已有的骨骼：骨骼较多处分配，较少处相加",
    ),
    "Pair the bones first": ("先にボーンをペアにしてください", "请先配对骨骼"),
    "Limit Bones": ("ボーン数を制限", "限制骨骼数"),
    "How many bones may move a vertex at most; 0 for any number": (
        "一つの頂点を動かせるボーンの最大数。0なら無制限",
        "每个顶点最多受多少骨骼带动；0 表示不限",
    ),
    "Motion": ("モーション", "运动"),
    (
        'The rotation of {0} of "{1}" is locked. Unlock it (in the sidebar: Item), or clear these bones in the table '
        "of pairs."
    ): (
        (
            '"{1}"の{0}の回転がロックされています。ロックを解除するか(サイドバー: アイテム)、ペアの表からこれらのボーン'
            "を消してください。"
        ),
        '"{1}" 的 {0} 的旋转已锁定。请解除锁定（侧栏：条目），或在配对表中清除这些骨骼。',
    ),
    'Constraints hold {0} of "{1}", so they may not follow the new motion. Mute them to see it.': (
        (
            'コンストレイントが"{1}"の{0}を拘束しているため、新しいモーションに従わないことがあります。見るにはミュート'
            "してください。"
        ),
        '约束控制着 "{1}" 的 {0}，因此它们可能不会跟随新的运动。请将其静音以查看。',
    ),
    'Drivers turn {0} of "{1}", which therefore do not follow the new motion. Mute them to see it.': (
        'ドライバーが"{1}"の{0}を回転させているため、新しいモーションに従いません。見るにはミュートしてください。',
        '驱动器在旋转 "{1}" 的 {0}，因此它们不会跟随新的运动。请将其静音以查看。',
    ),
    "Pairs of bones that are gone, or called otherwise by now, were left out: {0}. Pair the bones again.": (
        "なくなったか、名前が変わったボーンのペアは除外されました: {0}。ボーンをもう一度ペアにしてください。",
        "已不存在或已改名的骨骼的配对被略过：{0}。请重新配对骨骼。",
    ),
    (
        'The rest pose has changed since bones were paired, and these go by how they lie now: {0} of "{1}". Pair the '
        "bones again."
    ): (
        (
            'ボーンをペアにした後でレストポーズが変わったため、次のボーンは現在の向きに従います: "{1}"の{0}。ボーンをも'
            "う一度ペアにしてください。"
        ),
        '骨骼配对之后静置姿态已改变，以下骨骼按现在的朝向计算："{1}" 的 {0}。请重新配对骨骼。',
    ),
    (
        'Bones without a pair that are not at rest turn all that hangs on them: {0} of "{1}". Clear their pose (Pose > '
        "Clear Transform) unless that is wanted."
    ): (
        (
            'ペアがなく、レストポーズでもないボーンが、付いているものをすべて回転させています: "{1}"の{0}。意図したもの'
            "でなければ、そのポーズをクリアしてください(ポーズ > トランスフォームをクリア)。"
        ),
        (
            '没有配对且不在静置姿态的骨骼会带动挂在其上的一切旋转："{1}" 的 {0}。如非有意，请清除其姿态（姿态 > 清空变'
            "换）。"
        ),
    ),
    'Auto Keying set no keys: "{0}" plays an action of another file. Make it local, or let it play another one.': (
        (
            '自動キー挿入はキーを打ちませんでした: "{0}"が別のファイルのアクションを再生しているためです。ローカル化す'
            "るか、別のアクションを再生させてください。"
        ),
        '自动插帧没有插入关键帧："{0}" 播放的动作属于另一个文件。请将其本地化，或让它播放另一个动作。',
    ),
    '"{0}" was edited since it had been made. The edited one is kept as "{1}".': (
        "「{0}」は移された後に編集されていました。編集されたものは「{1}」として残してあります。",
        "“{0}”在传递之后被编辑过。编辑过的版本保留为“{1}”。",
    ),
    'Actions that move only the object "{0}", and none of its bones, were left out: {1}.': (
        'オブジェクト"{0}"だけを動かし、ボーンを動かさないアクションは移されませんでした: {1}。',
        '只移动物体 "{0}" 而不移动其骨骼的动作被略去：{1}。',
    ),
    '{0} changes the size of the object "{1}", too. That was left out.': (
        '{0}はオブジェクト"{1}"のサイズも変えます。それは移されませんでした。',
        '{0} 还会改变物体 "{1}" 的大小。这部分被略去。',
    ),
    (
        'All frames of {0} were computed: with keys only where the source has some "{1}" would move otherwise in '
        "between."
    ): (
        (
            '{0}のすべてのフレームを計算しました: ソースのキーの位置だけにキーを打つと、"{1}"はその間で違う動きになりま'
            "す。"
        ),
        '已计算 {0} 的所有帧：若只在源有关键帧之处设关键帧，"{1}" 在其间的运动会不同。',
    ),
    (
        '{0} of "{1}" will stay beyond the last key, where the source turns on: quaternions do not go on as Euler '
        "angles do. Give these bones the rotation modes that those of the source have, and carry it again."
    ): (
        (
            '"{1}"の{0}は最後のキーで止まりますが、ソースはその後も回り続けます: クォータニオンはオイラー角のようには続'
            "きません。これらのボーンの回転モードをソースのボーンと同じにして、もう一度移してください。"
        ),
        (
            '"{1}" 的 {0} 在最后一个关键帧处停下，而源在其后继续旋转：四元数不会像欧拉角那样延续。请让这些骨骼采用源骨'
            "骼的旋转模式，然后重新传递。"
        ),
    ),
    "In the place of meta strips the strips within them were copied: {0}.": (
        "メタストリップの代わりに、その中のストリップをコピーしました: {0}。",
        "元片段已由其中的片段代替复制：{0}。",
    ),
    (
        'Bones that are connected do not move away from what they hang on, as those of the source do: {0} of "{1}". To '
        "carry that as well disconnect them (Armature > Parent > Disconnect Bone in Edit Mode)."
    ): (
        (
            '接続されたボーンは、ソースのボーンのように親から離れて動きません: "{1}"の{0}。それも移すには、接続を解除し'
            "てください(編集モードでアーマチュア > ペアレント > ボーンを切り離す)。"
        ),
        (
            '相连的骨骼不会像源的骨骼那样离开父级移动："{1}" 的 {0}。若也要传递这种移动，请断开它们（编辑模式下骨架 > '
            "父级 > 断开骨骼）。"
        ),
    ),
    'The sizes that bones of "{0}" get were left out: {1}.': (
        '"{0}"のボーンのサイズの変化は移されませんでした: {1}。',
        '"{0}" 的骨骼大小变化被略去：{1}。',
    ),
    'The action "{0}" was deleted meanwhile. Nothing was written.': (
        'アクション"{0}"がその間に削除されました。何も書き込まれていません。',
        '动作 "{0}" 在此期间被删除。未写入任何内容。',
    ),
    'Source and Target are both "{0}". Choose two different armatures.': (
        'ソースとターゲットがどちらも"{0}"です。異なる二つのアーマチュアを選んでください。',
        '源和目标都是 "{0}"。请选择两个不同的骨架。',
    ),
    "Reading motion": ("モーションを読み込み中", "正在读取运动"),
    "Pairing bones": ("ボーンをペアにしています", "正在配对骨骼"),
    'No bone of "{0}" moves what one of "{1}" moves. Check the match, and that both meshes have weights.': (
        (
            '"{0}"のどのボーンも、"{1}"のボーンが動かすところを動かしません。マッチングと、両方のメッシュにウェイトがあ'
            "ることを確認してください。"
        ),
        '"{0}" 没有任何骨骼带动 "{1}" 的骨骼所带动的部位。请检查匹配，以及两个网格是否都有权重。',
    ),
    'The bones of "{0}" were changed meanwhile. Nothing was written.': (
        '"{0}"のボーンがその間に変更されました。何も書き込まれていません。',
        '"{0}" 的骨骼在此期间被更改。未写入任何内容。',
    ),
    '"{0}" of "{1}" is not in the table of pairs.': (
        '"{1}"の"{0}"はペアの表にありません。',
        '"{1}" 的 "{0}" 不在配对表中。',
    ),
    "Which bones are meant is open. Make one bone of each armature active, in Pose Mode.": (
        "どのボーンか不明です。ポーズモードで、それぞれのアーマチュアのボーンを一つアクティブにしてください。",
        "不清楚指的是哪些骨骼。请在姿态模式下将每个骨架的一个骨骼设为活动。",
    ),
    "Carrying motion over": ("モーションを移しています", "正在传递运动"),
    (
        '"{0}" has no action that moves its bones, but there are some of {1}. Exchange Source and Target, or name an '
        "action."
    ): (
        (
            '"{0}"にはボーンを動かすアクションがありませんが、{1}にはあります。ソースとターゲットを入れ替えるか、アクシ'
            "ョン名を指定してください。"
        ),
        '"{0}" 没有移动其骨骼的动作，但 {1} 有。请交换源和目标，或指定一个动作。',
    ),
    '"{0}" has no action that moves its bones. Give it one, or name an action.': (
        '"{0}"にはボーンを動かすアクションがありません。割り当てるか、アクションを指定してください。',
        '"{0}" 没有移动其骨骼的动作。请为其指定一个，或给出动作名称。',
    ),
    '"{0}" plays "{1}", which moves none of its bones. Name one of these, or choose all: {2}.': (
        '"{0}"が再生している"{1}"はボーンを動かしません。次のいずれかを指定するか、すべてを選んでください：{2}。',
        '"{0}" 正在播放的 "{1}" 不移动其骨骼。请指定其中之一，或选择全部：{2}。',
    ),
    '"{0}" plays no action. Name one of these, or choose all: {1}.': (
        '"{0}"はアクションを再生していません。次のいずれかを指定するか、すべてを選んでください：{1}。',
        '"{0}" 没有播放任何动作。请指定其中之一，或选择全部：{1}。',
    ),
    'The action "{0}" moves no bone of "{1}". Choose one that does.': (
        'アクション"{0}"は"{1}"のボーンを動かしません。動かすものを選んでください。',
        '动作 "{0}" 不移动 "{1}" 的任何骨骼。请选择会移动的动作。',
    ),
    'No action that moves bones of "{0}" fits the pattern "{1}". Its actions are {2}.': (
        '"{0}"のボーンを動かすアクションで、パターン"{1}"に合うものがありません。あるアクションは{2}です。',
        '没有移动 "{0}" 的骨骼的动作符合模式 "{1}"。它的动作有 {2}。',
    ),
    'No bones of "{0}" and "{1}" are paired. Pair their bones first.': (
        '"{0}"と"{1}"のボーンはペアになっていません。先にペアにしてください。',
        '"{0}" 和 "{1}" 没有配对的骨骼。请先配对骨骼。',
    ),
    'No pair of the file fits the bones of "{0}" and "{1}".': (
        'ファイルのどのペアも"{0}"と"{1}"のボーンに合いません。',
        '文件中没有配对适合 "{0}" 和 "{1}" 的骨骼。',
    ),
    '"{0}" has no bone called "{1}".': ('"{0}"に"{1}"というボーンはありません。', '"{0}" 没有名为 "{1}" 的骨骼。'),
    "The file holds no pairs of bones. Choose one that was exported from HierMatch.": (
        "ファイルにボーンのペアがありません。HierMatchから書き出したものを選んでください。",
        "文件中没有骨骼配对。请选择由 HierMatch 导出的文件。",
    ),
    'There is no action called "{0}". Those of "{1}" are {2}.': (
        '"{0}"というアクションはありません。"{1}"のアクションは{2}です。',
        '没有名为 "{0}" 的动作。"{1}" 的动作有 {2}。',
    ),
    '"{0}" has no armature. Choose an armature, or a mesh with an Armature modifier.': (
        '"{0}"にアーマチュアがありません。アーマチュアか、アーマチュアモディファイアーを持つメッシュを選んでください。',
        '"{0}" 没有骨架。请选择骨架，或带有骨架修改器的网格。',
    ),
    'The armature "{0}" has no bones.': ('アーマチュア"{0}"にボーンがありません。', '骨架 "{0}" 没有骨骼。'),
    (
        'The armature "{0}" is linked from another file and cannot be animated here. Make a library override of its '
        "character first (Object > Library Override > Make)."
    ): (
        (
            'アーマチュア"{0}"は他のファイルからリンクされているため、ここではアニメーションできません。先にキャラクタ'
            "ーのライブラリオーバーライドを作成してください(オブジェクト > ライブラリオーバーライド > 作成)。"
        ),
        '骨架 "{0}" 链接自其他文件，无法在此制作动画。请先为其角色创建库重写（物体 > 库重写 > 创建）。',
    ),
    (
        'The armature "{0}" is a library override that cannot be edited. Make it editable first (Object > Library '
        "Override > Make)."
    ): (
        (
            'アーマチュア"{0}"は編集できないライブラリオーバーライドです。先に編集可能にしてください(オブジェクト > ラ'
            "イブラリオーバーライド > 作成)。"
        ),
        '骨架 "{0}" 是无法编辑的库重写。请先使其可编辑（物体 > 库重写 > 创建）。',
    ),
    (
        'A strip of "{0}" is being tweaked in the NLA editor, which holds its action. Leave the tweak mode there first '
        "(Tab)."
    ): (
        (
            '"{0}"のストリップがNLAエディターで調整中のため、アクションが固定されています。先に調整モードを終了してくだ'
            "さい(Tab)。"
        ),
        '"{0}" 的一个片段正在 NLA 编辑器中调整，其动作被锁定。请先在那里退出调整模式（Tab）。',
    ),
    '"{0}" has no weights for the bones of an armature. Choose a rigged Source.': (
        '"{0}"にはアーマチュアのボーンのウェイトがありません。リグを持つソースを選んでください。',
        '"{0}" 没有骨架骨骼的权重。请选择已绑定的源。',
    ),
    'The bones of "{0}" were changed. Pair the bones again.': (
        '"{0}"のボーンが変更されました。もう一度ボーンをペアにしてください。',
        '"{0}" 的骨骼已被更改。请重新配对骨骼。',
    ),
    (
        'The vertex groups of all paired bones of "{0}" are locked on "{1}", or the bones do not deform. Unlock some '
        "of them."
    ): (
        (
            '"{0}"のペアになったボーンの頂点グループがすべて"{1}"でロックされているか、ボーンが変形しません。いくつかの'
            "ロックを解除してください。"
        ),
        '"{0}" 的所有配对骨骼的顶点组在 "{1}" 上已锁定，或这些骨骼不变形。请解锁其中一些。',
    ),
    "Transferring rotations": ("回転を移しています", "正在传递旋转"),
    "Posing the bones": ("ボーンにポーズを付けています", "正在摆放骨骼"),
    "Keeping the feet": ("足を保っています", "正在保持脚部"),
    "Keeping the hands": ("手を保っています", "正在保持手部"),
    'Paired "{0}" with "{1}"': ('"{0}"を"{1}"とペアにしました', '已将 "{0}" 与 "{1}" 配对'),
    '"{0}" stays alone': ('"{0}"は単独のままです', '"{0}" 保持单独'),
    '"{0}" was taken out of the table': ('"{0}"を表から取り除きました', '"{0}" 已从表中移除'),
    "{0} pairs were taken out of the table": ("{0}組のペアを表から取り除きました", "已从表中移除 {0} 对"),
    'The pairs of bones were saved to "{0}"': ('ボーンのペアを"{0}"に保存しました', '骨骼配对已保存到 "{0}"'),
    "{0} pairs were loaded": ("{0}組のペアを読み込みました", "已加载 {0} 对"),
    "{0} pairs were loaded. These bones are missing: {1}": (
        "{0}組のペアを読み込みました。次のボーンがありません: {1}",
        "已加载 {0} 对。缺少这些骨骼：{1}",
    ),
    (
        'By their names, left bones of "{0}" are paired with right ones of "{1}". If that is wrong, one of them looks '
        "the other way, or the match is mirrored: use another answer of the match, and pair the bones again."
    ): (
        (
            '名前によると、"{0}"の左のボーンが"{1}"の右のボーンとペアになっています。それが誤りなら、一方が逆を向いてい'
            "るか、マッチングが左右反転しています。マッチングの別の解を使い、もう一度ボーンをペアにしてください。"
        ),
        (
            '按名称看，"{0}" 的左侧骨骼与 "{1}" 的右侧骨骼配对。若有误，说明其中一个朝向相反，或匹配是镜像的：请使用匹'
            "配的另一个解，再重新配对骨骼。"
        ),
    ),
    "Symmetrise": ("対称化", "对称化"),
    "Test Poses": ("ポーズのテスト", "测试姿势"),
    (
        "Bend every joint of the target's rig in turn, with a marker for each on the timeline; pressed again, all of "
        "it is taken away"
    ): (
        (
            "ターゲットのリグの関節を一つずつ順に曲げます。タイムラインにそれぞれのマーカーが付きます。もう一度押すと、"
            "すべて取り除かれます"
        ),
        "依次弯曲目标骨架的每个关节，并在时间线上为每个关节放置标记；再按一次即全部移除",
    ),
    (
        "Name of the mesh or armature; if empty, the one picked in the panel, that of the last retarget, or else the "
        "active object"
    ): (
        (
            "メッシュまたはアーマチュアの名前。空の場合は、パネルで選んだもの、最後のリターゲットのもの、またはアクティ"
            "ブオブジェクト"
        ),
        "网格或骨架的名称；为空时使用面板中选取的物体、上次重定向的物体，否则使用活动物体",
    ),
    "Remove": ("取り除く", "移除"),
    "Take test poses away, and make none if there are none": (
        "テスト用のポーズを取り除きます。なければ何も作りません",
        "移除测试姿势；若没有则不新建",
    ),
    'The test poses of "{0}" are gone': ("「{0}」のテスト用ポーズを取り除きました", "已移除“{0}”的测试姿势"),
    'No bone of "{0}" moves a mesh. Transfer the weights first.': (
        "「{0}」にはメッシュを動かすボーンがありません。先にウェイトを転送してください。",
        "“{0}”没有驱动网格的骨骼。请先传递权重。",
    ),
    '"{0}" bends {1} in {2} frames. Space plays it, the button ends it': (
        "「{0}」は{1}を{2}フレームで曲げます。スペースキーで再生し、ボタンで終わります",
        "“{0}”在 {2} 帧内弯曲 {1}。按空格键播放，按此按钮结束",
    ),
    "Before and After": ("前と後", "前后对比"),
    (
        "Show the target as it stood before it got rig, shape keys and clothes; pressed again, as it is now, with the "
        "pose that it was in"
    ): (
        "リグ、シェイプキー、衣服を受け取る前のターゲットを表示します。もう一度押すと、今の状態とポーズに戻ります",
        "显示目标获得骨架、形态键和服装之前的样子；再按一次则恢复现在的样子和姿势",
    ),
    "Name of the mesh; if empty, the one picked in the panel, that of the last retarget, or else the active object": (
        "メッシュの名前。空の場合は、パネルで選んだもの、最後のリターゲットのもの、またはアクティブオブジェクト",
        "网格的名称；为空时使用面板中选取的物体、上次重定向的物体，否则使用活动物体",
    ),
    '"{0}" is shown as it is': ("「{0}」を今の状態で表示しています", "“{0}”以现在的样子显示"),
    '"{0}" is shown as it was before': ("「{0}」を元の状態で表示しています", "“{0}”以之前的样子显示"),
    '"{0}" has no rig, shape keys or clothes that came from a source, so it is as it was before.': (
        "「{0}」にはソースから来たリグ、シェイプキー、衣服がないので、元のままです。",
        "“{0}”没有来自源的骨架、形态键或服装，因此就是之前的样子。",
    ),
    "It is open which character is meant. Pick it as the Target, or make it the active object.": (
        "どのキャラクターかが決まっていません。ターゲットに選ぶか、アクティブオブジェクトにしてください。",
        "不清楚指的是哪个角色。请将其选为目标，或设为活动物体。",
    ),
    '"{0}" has no armature that could bend it. Retarget it with Rig on first.': (
        "「{0}」には曲げるためのアーマチュアがありません。先に「リグ」をオンにしてリターゲットしてください。",
        "“{0}”没有可以使其弯曲的骨架。请先开启“骨架”进行重定向。",
    ),
    '"{0}" is linked from another file and cannot be posed. Make it local first.': (
        "「{0}」は他のファイルからリンクされており、ポーズを付けられません。先にローカル化してください。",
        "“{0}”链接自其他文件，无法摆姿势。请先将其本地化。",
    ),
    (
        "Take weights, shape keys and colors of one side of a mesh to its other side, also if its pose or its topology "
        "is not symmetric"
    ): (
        "ポーズやトポロジーが対称でなくても、メッシュの片側のウェイト、シェイプキー、色を反対側に写します",
        "将网格一侧的权重、形态键和颜色复制到另一侧，即使其姿态或拓扑不对称",
    ),
    "Name of the object to make symmetric; if empty, the active object": (
        "対称にするオブジェクトの名前。空ならアクティブオブジェクト",
        "要对称化的物体名称；为空时使用活动物体",
    ),
    "Symmetry": ("対称", "对称"),
    "Starting": ("開始しています", "正在开始"),
    "The Prefix is empty. Enter what the names of the vertex groups shall start with.": (
        "接頭辞が空です。頂点グループの名前の先頭に付ける文字列を入力してください。",
        "前缀为空。请输入顶点组名称的开头。",
    ),
    "The Prefix is too long. Enter one of at most {0} letters, or {1} in Chinese or Japanese.": (
        "接頭辞が長すぎます。英数字で{0}文字まで、日本語や中国語で{1}文字までにしてください。",
        "前缀过长。请输入最多 {0} 个字母，或 {1} 个中文或日文字符。",
    ),
    "This file of landmarks is of a newer version of HierMatch. Update the extension.": (
        "このランドマークのファイルは新しいバージョンのHierMatchのものです。エクステンションを更新してください。",
        "此地标文件来自更新版本的 HierMatch。请更新扩展。",
    ),
    "This is no file of landmarks, or it is damaged. Choose one that Save Landmarks has written.": (
        (
            "これはランドマークのファイルではないか、破損しています。「ランドマークを保存」で書き出したファイルを選んで"
            "ください。"
        ),
        "这不是地标文件，或文件已损坏。请选择由“保存地标”写入的文件。",
    ),
    "Prepared Shapes (MB)": ("準備済みの形状 (MB)", "已准备的形状 (MB)"),
    (
        "Memory for what is computed of a mesh alone, kept until Blender is closed, so that matching it again, or with "
        "another mesh, takes less time. With 0 nothing is kept"
    ): (
        (
            "メッシュだけから計算される内容を保持するメモリ。Blenderを閉じるまで保持され、同じメッシュを再び、または別"
            "のメッシュとマッチングするときの時間を短縮します。0では何も保持しません"
        ),
        (
            "用于保存仅由网格自身计算出的内容的内存，保留到 Blender 关闭为止，这样再次匹配该网格或与其他网格匹配时用时"
            "更少。为 0 时不保留任何内容"
        ),
    ),
    "Forget Prepared Shapes": ("準備済みの形状を破棄", "丢弃已准备的形状"),
    "Free the memory of the meshes that were matched in this session; matching one again prepares it anew": (
        "このセッションでマッチングしたメッシュのメモリを解放します。再びマッチングするときは改めて準備されます",
        "释放本次会话中匹配过的网格所占的内存；再次匹配时会重新准备",
    ),
    "The prepared shapes were forgotten": ("準備済みの形状を破棄しました", "已丢弃准备好的形状"),
    (
        "The process that did the work ended before it was done, maybe for want of memory. Nothing was changed. Close "
        "other programs or use smaller meshes, and try again."
    ): (
        (
            "作業をしていたプロセスが、終わる前に終了しました。メモリ不足かもしれません。何も変更されていません。ほかの"
            "プログラムを閉じるか、より小さいメッシュを使い、もう一度お試しください。"
        ),
        "执行工作的进程在完成之前就结束了，可能是内存不足。没有做任何更改。请关闭其他程序或使用较小的网格，然后重试。",
    ),
    "HierMatch is at work. Wait for it, or cancel it": (
        "HierMatchが作業中です。待つか、キャンセルしてください",
        "HierMatch 正在工作。请等待或取消",
    ),
    "Switch to Object Mode or to Edit Mode first": (
        "先にオブジェクトモードまたは編集モードに切り替えてください",
        "请先切换到物体模式或编辑模式",
    ),
    (
        "It is open which vertices correspond. Select one vertex on each mesh in Edit Mode, or two empties near the "
        "surfaces in Object Mode, or click on them with Pick Landmarks."
    ): (
        (
            "どの頂点が対応するのかが決まりません。編集モードで各メッシュの頂点を一つずつ選択するか、オブジェクトモード"
            "で表面の近くの二つのエンプティを選択するか、「ランドマークを指定」でクリックしてください。"
        ),
        (
            "无法确定哪些顶点对应。请在编辑模式下于每个网格上选择一个顶点，或在物体模式下选择表面附近的两个空物体，或用"
            "“拾取地标”点击它们。"
        ),
    ),
    "The file holds the symmetry of one mesh, not the match of two. Choose another file.": (
        (
            "このファイルには二つのメッシュのマッチングではなく、一つのメッシュの対称性が入っています。別のファイルを選"
            "んでください。"
        ),
        "该文件保存的是一个网格的对称性，而不是两个网格的匹配。请选择其他文件。",
    ),
    "Nothing is running": ("実行中のものはありません", "没有正在运行的任务"),
    "There is nothing here that HierMatch has written": (
        "HierMatchが書き込んだものはここにはありません",
        "这里没有 HierMatch 写入的内容",
    ),
    "None of these objects carries anything that HierMatch has written.": (
        "これらのオブジェクトはどれもHierMatchが書き込んだものを持っていません。",
        "这些物体都没有 HierMatch 写入的内容。",
    ),
    "No landmark is chosen. Choose one in the list, or add one.": (
        "ランドマークが選ばれていません。リストから選ぶか、追加してください。",
        "未选择地标。请在列表中选择一个，或添加一个。",
    ),
    "There is no such matched point. Match Source and Target first, or choose a point in the list.": (
        "その対応点はありません。先にソースとターゲットをマッチングするか、リストからポイントを選んでください。",
        "没有这个匹配点。请先匹配源与目标，或在列表中选择一个点。",
    ),
    "There is no match to flip. Match two meshes first, or name one that carries a match.": (
        (
            "切り替えるマッチングがありません。先に二つのメッシュをマッチングするか、マッチングを持つメッシュを指定して"
            "ください。"
        ),
        "没有可切换的匹配。请先匹配两个网格，或指定一个带有匹配的网格。",
    ),
    "No file is named. Choose one.": ("ファイルが指定されていません。選んでください。", "没有指定文件。请选择一个。"),
    "Two mesh objects are needed in this view layer": (
        "このビューレイヤーに二つのメッシュオブジェクトが必要です",
        "此视图层中需要两个网格物体",
    ),
    "Two mesh objects are needed in this view layer. Make library overrides of what instances show, or make it real": (
        (
            "このビューレイヤーに二つのメッシュオブジェクトが必要です。インスタンスが示すものは、ライブラリオーバーライ"
            "ドにするか、実体化してください"
        ),
        "此视图层中需要两个网格物体。请为实例所显示的内容创建库重写，或使其独立",
    ),
    "There is nothing to click on. Use hiermatch.add_landmark with two vertices.": (
        "クリックできるものがありません。二つの頂点を指定してhiermatch.add_landmarkを使ってください。",
        "没有可点击的对象。请用两个顶点调用 hiermatch.add_landmark。",
    ),
    '"{0}" was edited since the click on it. Click on its place again.': (
        "「{0}」はクリックした後に編集されました。もう一度その場所をクリックしてください。",
        "“{0}”在点击之后被编辑过。请重新点击该处。",
    ),
    (
        'The match exchanges left and right between "{0}" and "{1}", and clothes and motion cannot be carried across '
        "it. Press Use Mirrored Match once more, or match again."
    ): (
        (
            "このマッチングは「{0}」と「{1}」の左右を入れ替えているため、衣服とモーションは転写できません。「ミラーマッ"
            "チングを使用」をもう一度押すか、マッチングし直してください。"
        ),
        "该匹配交换了“{0}”与“{1}”的左右，衣物和动作无法通过它传递。请再按一次“使用镜像匹配”，或重新匹配。",
    ),
    (
        'That place of "{0}" is shown by its Mirror modifier. Click on the half that is a mesh, or apply the modifier '
        "first."
    ): (
        (
            "「{0}」のその場所はミラーモディファイアーが表示しています。メッシュそのものである半分をクリックするか、先"
            "にモディファイアーを適用してください。"
        ),
        "“{0}”的该处是由镜像修改器显示的。请点击网格本身的那一半，或先应用该修改器。",
    ),
    "One of the two meshes was deleted. Press Esc and start again.": (
        "二つのメッシュの一方が削除されました。Escを押してやり直してください。",
        "两个网格之一被删除。请按 Esc 后重新开始。",
    ),
    (
        '"{0}" is linked from another file, so its matches cannot be shown or refined. Make object and data local '
        "first (Object > Relations > Make Local)."
    ): (
        (
            "「{0}」は他のファイルからリンクされているため、そのマッチングは表示も改良もできません。先にオブジェクトと"
            "データをローカル化してください（オブジェクト > 関係 > ローカル化）。"
        ),
        "“{0}”链接自其他文件，因此其匹配无法显示或改善。请先将物体和数据本地化（物体 > 关系 > 本地化）。",
    ),
    "There is no match to refine. Pick two meshes as Source and Target, and match them.": (
        "改良するマッチングがありません。二つのメッシュをソースとターゲットに選び、マッチングしてください。",
        "没有可改善的匹配。请选取两个网格作为源和目标并进行匹配。",
    ),
    "A landmark is far from where the map had taken it. If the result is wrong, match again.": (
        (
            "あるランドマークが、マップが示していた場所から遠く離れています。結果が誤っていたら、再マッチングしてくださ"
            "い。"
        ),
        "某个地标远离映射原来所指的位置。如果结果有误，请重新匹配。",
    ),
    "There is no match to show. Pick two meshes as Source and Target, and match them.": (
        "表示するマッチングがありません。二つのメッシュをソースとターゲットに選び、マッチングしてください。",
        "没有可显示的匹配。请选取两个网格作为源和目标并进行匹配。",
    ),
    "Pick a Source or a Target first": ("先にソースまたはターゲットを選んでください", "请先选取源或目标"),
    "It is open which mesh is to be made symmetric. Make it the active object.": (
        "どのメッシュを対称にするのかが決まりません。アクティブオブジェクトにしてください。",
        "无法确定要对称化哪个网格。请将其设为活动物体。",
    ),
    "Leave Out": ("除外", "排除"),
    "Output": ("出力", "输出"),
    "Advanced": ("詳細設定", "高级"),
    "Of Source": ("ソースから", "源中"),
    "Of Target": ("ターゲットから", "目标中"),
    "Write": ("書込", "写入"),
    "Pick two meshes, or select them: the active one is the source": (
        "二つのメッシュを指定するか、選択してください。アクティブな方がソースです",
        "选取两个网格，或直接选中它们：活动网格为源",
    ),
    "Measuring the matched points": ("対応点を計測しています", "正在测量匹配点"),
    '{0} of the items were added to the rig of "{1}".': (
        '"{1}"のリグに、アイテムの{0}を追加しました。',
        '已将物品的{0}添加到 "{1}" 的骨架。',
    ),
    (
        'The rig of "{0}" has other bones, so the weights were taken from its skin and from the bones that are paired '
        "with the items' own."
    ): (
        '"{0}"のリグにはほかのボーンがあるため、ウェイトは肌と、アイテム自身のボーンとペアのボーンから取りました。',
        '"{0}" 的绑定使用其他骨骼，因此权重取自其皮肤，以及与物品自身骨骼配对的骨骼。',
    ),
    (
        'The armature "{0}" is linked from another file, so bones of the items were not added to it. Make it local '
        "first."
    ): (
        (
            'アーマチュア"{0}"はほかのファイルからリンクされているため、アイテムのボーンは追加されませんでした。先にロ'
            "ーカルにしてください。"
        ),
        '骨架 "{0}" 链接自其他文件，因此未向其添加物品的骨骼。请先将其设为本地。',
    ),
    "Follow Shape Keys": ("シェイプキーに従う", "跟随形态键"),
    (
        "Give the fitted items the other body's shape keys that move it below them, driven by its own: they follow a "
        "wide belly or a squat"
    ): (
        (
            "合わせたアイテムに、その下で相手のボディを動かすシェイプキーを与え、ボディのキーで駆動します。大きな腹やし"
            "ゃがみに付いていきます"
        ),
        "为适配后的物品添加另一身体在其下方起作用的形态键，并由身体的形态键驱动：它们会跟随变大的腹部或下蹲",
    ),
    "Following shape keys": ("シェイプキーに従わせています", "正在跟随形态键"),
    '"{0}" follows {1} of "{2}".': ('"{0}"は"{2}"の{1}に従います。', '"{0}" 跟随 "{2}" 的 {1}。'),
    '{0} of "{1}" could not be bound to "{2}". Bind it by hand.': (
        '"{1}"の{0}を"{2}"にバインドできませんでした。手動でバインドしてください。',
        '"{1}" 的 {0} 无法绑定到 "{2}"。请手动绑定。',
    ),
    '"{0}" was edited after it had been fitted. As it was then it is kept, hidden, as {1}.': (
        "「{0}」はフィット後に編集されていました。編集されたものは{1}として非表示で残してあります。",
        "“{0}”在贴合之后被编辑过。编辑过的版本已隐藏并保留为{1}。",
    ),
    'What was painted on "{0}" in {1} changes nothing: paint it on "{2}".': (
        "「{0}」の{1}に描かれたものは効果がありません。「{2}」に描いてください。",
        "在“{0}”的{1}中所绘制的内容不起作用：请绘制到“{2}”上。",
    ),
    '"{0}" is an armature, and items are meshes. Name those that it moves: {1}.': (
        '"{0}"はアーマチュアですが、アイテムはメッシュです。それが動かすメッシュの名前を挙げてください: {1}。',
        '"{0}" 是骨架，而物品是网格。请指定它所带动的网格：{1}。',
    ),
    '"{0}" is an armature, and items are meshes. It moves none but a body: name others, or take it out.': (
        (
            '"{0}"はアーマチュアですが、アイテムはメッシュです。体のほかには何も動かしていません: ほかのものを指定する'
            "か、外してください。"
        ),
        '"{0}" 是骨架，而物品是网格。除身体外它不带动任何网格：请指定其他网格，或将其去掉。',
    ),
    (
        'Drivers of "{0}" still read from {1}: "{2}" has not what they need. Carry its shape keys or bones over by '
        "Retarget, and fit it again."
    ): (
        (
            '"{0}"のドライバーはまだ{1}を参照しています。"{2}"に必要なものがありません。リターゲットでシェイプキーやボ'
            "ーンを移してから、もう一度合わせてください。"
        ),
        '"{0}" 的驱动器仍读取 {1}："{2}" 没有它们所需的内容。请用重定向传递其形态键或骨骼，然后重新适配。',
    ),
    'Modifiers of "{0}" still use {1}, as those of the original do. Put a copy of it where "{2}" is, and pick that.': (
        (
            '"{0}"のモディファイアーは、元のものと同じく、まだ{1}を使っています。"{2}"のある所にその複製を置き、それを'
            "選んでください。"
        ),
        '"{0}" 的修改器和原物体一样仍使用 {1}。请在 "{2}" 所在处放置其副本，并选用该副本。',
    ),
    "The collection of {0} is hidden or left out. Show it in the Outliner.": (
        "{0}のコレクションは非表示か除外されています。アウトライナーで表示してください。",
        "{0} 所在的集合已隐藏或排除。请在大纲视图中显示它。",
    ),
    "Mend in Poses": ("ポーズで補正", "在姿势中修正"),
    (
        "Bend each joint of the other body's rig, and where its skin pokes through an item then, bring the weights "
        "there closer to those of the skin, and lift the item a little"
    ): (
        (
            "相手のボディのリグの各関節を曲げてみて、肌がアイテムを突き抜けるところでは、ウェイトを肌のものに近づけ、ア"
            "イテムを少し浮かせます"
        ),
        "弯曲另一身体绑定的每个关节，若皮肤此时穿出物品，则使该处的权重更接近皮肤的权重，并将物品略微抬起",
    ),
    (
        "Fit clothes, hair and accessories of the source, which are objects of their own, to the matched bodies. "
        "Without named items it takes the selected ones, or else, if the source is one mesh, all others that its "
        "armature moves"
    ): (
        (
            "ソースの服・髪・アクセサリー（それぞれ独立したオブジェクト）を、マッチングしたボディに合わせます。アイテム"
            "の指定がなければ選択中のもの、それもなく、ソースが一つのメッシュなら、そのアーマチュアが動かすほかのすべて"
            "のものを使います"
        ),
        (
            "将源的服装、头发和配饰（各自为独立的物体）适配到匹配的身体上。未指定物品时使用所选物体；若未选择且源为单个"
            "网格，则使用其骨架所带动的其他全部物体"
        ),
    ),
    (
        "Names of the objects to fit; if empty, those in the collection, or else the selected ones, or else, if the "
        "source is one mesh, all others that its armature moves"
    ): (
        (
            "合わせるオブジェクトの名前。空の場合はコレクション内のもの、なければ選択中のもの、それもなく、ソースが一つ"
            "のメッシュなら、そのアーマチュアが動かすほかのすべてのもの"
        ),
        (
            "要适配的物体名称；为空时使用集合中的物体，否则使用所选物体；若未选择且源为单个网格，则使用其骨架所带动的其"
            "他全部物体"
        ),
    ),
    "Their own, if the other body's rig has these bones, or else those of its skin": (
        "相手のボディのリグに同じボーンがあれば自身のウェイト、なければ肌のウェイト",
        "若另一身体的绑定有这些骨骼则用自身的权重，否则用其皮肤的权重",
    ),
    "Those of the other body's skin, from where the items lie on it": (
        "アイテムが載っている場所の、相手のボディの肌のウェイト",
        "取自另一身体皮肤上物品所在之处的权重",
    ),
    '"{0}" has no armature, so what was fitted to it is not bound. Give it one by Retarget, and fit it again.': (
        (
            '"{0}"にはアーマチュアがないため、合わせたものはバインドされていません。リターゲットでアーマチュアを与えて'
            "から、もう一度合わせてください。"
        ),
        '"{0}"没有骨架，因此适配到它上面的物品未绑定。请通过"重定向"为其添加骨架，然后重新适配。',
    ),
    '"{0}" is far from "{1}". Move it to where the body wears it, or pick that body as the Source.': (
        '"{0}"は"{1}"から遠く離れています。ボディが身に着ける位置に移動するか、そのボディをソースに選んでください。',
        '"{0}"距离"{1}"太远。请将其移到身体穿戴它的位置，或选择相应的身体作为源。',
    ),
    '"{0}" is not a mesh but of type {1}. Convert a copy of it (Object > Convert > Mesh), and fit that.': (
        (
            '"{0}"はメッシュではなく{1}タイプです。コピーを変換して（オブジェクト > 変換 > メッシュ）、それを合わせてく'
            "ださい。"
        ),
        '"{0}"不是网格，而是{1}类型。请转换其副本（物体 > 转换 > 网格），再适配该副本。',
    ),
    '"{0}" is the body itself, picked as the {1}. Take it out of the items, or pick another body.': (
        '"{0}"は{1}に選ばれているボディそのものです。アイテムから外すか、別のボディを選んでください。',
        '"{0}"就是被选为{1}的身体本身。请将其从物品中移除，或选择另一身体。',
    ),
    '"{0}" lies on "{1}", not on "{2}". Swap Source and Target, or take it out of the items.': (
        '"{0}"は"{2}"ではなく"{1}"の上にあります。ソースとターゲットを入れ替えるか、アイテムから外してください。',
        '"{0}"位于"{1}"上，而不在"{2}"上。请交换源和目标，或将其从物品中移除。',
    ),
    "A copy of each item, in a collection of its own": (
        "各アイテムのコピーを専用のコレクションに作ります",
        "每件物品的副本，放在单独的集合中",
    ),
    "A shape key on each item that moves it to the other body": (
        "各アイテムに、相手のボディへ移すシェイプキーを作ります",
        "在每件物品上添加一个将其移到另一身体的形态键",
    ),
    "As It Is": ("そのまま", "保持原样"),
    "Body Below": ("下のボディ", "下方的身体"),
    "Clearance": ("すき間", "间隙"),
    "Close to the skin it follows each form of it, far from it only the body as a whole": (
        "肌の近くではその形に沿い、離れたところではボディ全体にだけ従います",
        "靠近皮肤处贴合其每处形状，远离处只跟随整个身体",
    ),
    "Collection": ("コレクション", "集合"),
    "Find Rigid Parts": ("硬いパーツを探す", "查找刚性部件"),
    "Fit": ("フィット", "贴合方式"),
    "Fitted Copies": ("合わせたコピー", "适配的副本"),
    "Fitting clothes": ("服を合わせています", "正在适配服装"),
    "From the Skin": ("肌から", "取自皮肤"),
    "How many bones may move a vertex: the smallest weights go. 0 for any number": (
        "一つの頂点を動かせるボーンの数。小さいウェイトから除かれます。0なら無制限",
        "一个顶点最多受多少骨骼影响：去除最小的权重。0表示不限",
    ),
    "How the item follows the body": ("アイテムがボディにどう従うか", "物品如何跟随身体"),
    (
        "If the other body has no armature, give it that of the first, with its weights, as Retarget does, so that "
        "body and clothes move"
    ): (
        (
            "相手のボディにアーマチュアがなければ、リターゲットと同じように元のアーマチュアとウェイトを与え、ボディと服"
            "が動くようにします"
        ),
        "若另一身体没有骨架，则像“重定向”那样给它原身体的骨架及权重，使身体和服装都能活动",
    ),
    "It follows each form of the skin, such as tights or a second skin": (
        "タイツのように、肌の形にぴったり沿います",
        "贴合皮肤的每处形状，例如紧身裤",
    ),
    "It gets a Mask modifier with a vertex group that hides it below clothes": (
        "服の下を隠す頂点グループを使ったマスクモディファイアーを付けます",
        "添加遮罩修改器及顶点组，隐藏服装下的身体",
    ),
    "It gets a shape key that draws it in below clothes": (
        "服の下を引っ込めるシェイプキーを付けます",
        "添加形态键，将服装下的身体向内收缩",
    ),
    "It is left as it is": ("そのままにします", "保持不变"),
    "It is moved along with the body, but not pushed out of it": (
        "ボディと一緒に移動しますが、外へ押し出しません",
        "随身体移动，但不会被推出身体",
    ),
    "It keeps its own shape and hangs as it did, such as a coat or long hair": (
        "コートや長い髪のように、自身の形を保ち、元のように垂れます",
        "保持自身形状并像原来那样垂挂，例如外套或长发",
    ),
    "It keeps its shape wholly and only grows, such as a helmet": (
        "ヘルメットのように、形を完全に保ち大きさだけ変わります",
        "完全保持形状，仅改变大小，例如头盔",
    ),
    "Items": ("アイテム", "物品"),
    (
        "Keep small solid parts as they are, such as buttons, buckles and glasses. Others can be named by a vertex "
        'group called "Rigid"'
    ): (
        (
            "ボタン、バックル、眼鏡などの小さく硬いパーツをそのままの形に保ちます。ほかのものは「Rigid」という頂点グル"
            "ープで指定できます"
        ),
        "保持小而坚硬的部件不变形，如纽扣、带扣和眼镜。其他部件可用名为“Rigid”的顶点组指定",
    ),
    "Least distance from the skin. With 0 it is what the items had on their own body, in the size of the other": (
        "肌からの最小距離。0なら、元のボディでの距離を相手の大きさに合わせたもの",
        "与皮肤的最小距离。为0时沿用物品在原身体上的距离，并按另一身体的大小缩放",
    ),
    "Leave": ("そのまま", "保留"),
    "Let the weights of all bones sum to one at each vertex. Locked groups keep theirs": (
        "各頂点ですべてのボーンのウェイトの合計を1にします。ロックされたグループは変わりません",
        "使每个顶点上所有骨骼的权重之和为1。锁定的组保持不变",
    ),
    "Loose": ("ゆったり", "宽松"),
    "Mask": ("マスク", "遮罩"),
    "Measuring": ("測定中", "正在测量"),
    "Moving items along": ("アイテムを移動しています", "正在移动物品"),
    "Moving the skin": ("肌を移動しています", "正在移动皮肤"),
    "Name of a collection whose meshes are fitted": (
        "メッシュを合わせるコレクションの名前",
        "要适配其中网格的集合名称",
    ),
    (
        'No clothes of "{0}" were found: all of its meshes count as its body. Select only those of them that are worn, '
        "with the other body, or name them."
    ): (
        (
            '"{0}"の服が見つかりません。そのメッシュはすべてボディとみなされます。着ているものだけをもう一方のボディと'
            "一緒に選択するか、名前を指定してください。"
        ),
        '未找到"{0}"的服装：它的所有网格都被视为身体。请只将其中穿着的网格与另一个身体一起选中，或指定其名称。',
    ),
    (
        'No clothes of "{0}" were found: no other mesh is bound to its armature. Pick both bodies as Source and '
        "Target, and select the items, or name them."
    ): (
        (
            '"{0}"の服が見つかりません。アーマチュアにバインドされたほかのメッシュがありません。両方のボディをソースと'
            "ターゲットに指定してアイテムを選択するか、名前を指定してください。"
        ),
        '未找到"{0}"的服装：没有其他网格绑定到它的骨架。请将两个身体分别选为源和目标，并选中物品，或指定其名称。',
    ),
    "Own": ("自身", "自身"),
    "Pushing items out": ("アイテムを外へ押し出しています", "正在将物品向外推"),
    "Rigid": ("硬い", "刚性"),
    "Show Fit": ("フィットを表示", "显示贴合情况"),
    "Show in this viewport what Wear has written with Show Fit on": (
        "「フィットを表示」をオンにした「着せる」が書き込んだものを、このビューポートに表示します",
        "在此视图中显示穿戴所写入的贴合情况",
    ),
    "Distance to Skin": ("肌からの距離", "到皮肤的距离"),
    "Show how far clothes are from the skin, from white to dark red; blue is inside": (
        "衣服が肌からどれだけ離れているかを白から暗い赤で表示します。青は内側です",
        "以白到深红显示服装离皮肤多远；蓝色表示在内部",
    ),
    "Pushed": ("押し出し", "推出量"),
    "Show how far clothes were pushed out of the skin, from white (not at all) to dark red": (
        "衣服が肌からどれだけ押し出されたかを、白（なし）から暗い赤で表示します",
        "以白（没有）到深红显示服装从皮肤中被推出多远",
    ),
    "Uncertain": ("不確かさ", "不确定"),
    "Show where the fit is uncertain, from white (nowhere) to dark red": (
        "フィットが不確かなところを、白（なし）から暗い赤で表示します",
        "以白（没有）到深红显示贴合不确定的地方",
    ),
    "Nothing here carries the colors of a fit. Press Wear with Show Fit on.": (
        "フィットのカラーを持つものがありません。「フィットを表示」をオンにして「着せる」を押してください。",
        "这里没有带有贴合颜色的物体。请打开显示贴合情况，再按穿戴。",
    ),
    "Shrink Key": ("縮小キー", "收缩键"),
    'The armature "{0}" has no bones {1} of "{2}". What they moved is moved by the bones of the skin below.': (
        'アーマチュア"{0}"には"{2}"のボーン{1}がありません。それらが動かしていた部分は、下の肌のボーンで動きます。',
        '骨架"{0}"没有"{2}"的骨骼{1}。它们所带动的部分改由下方皮肤的骨骼带动。',
    ),
    'The collection "{0}" has no meshes that could be fitted.': (
        'コレクション"{0}"には合わせられるメッシュがありません。',
        '集合"{0}"中没有可适配的网格。',
    ),
    "Their own, whatever bones the other body has": (
        "相手のボディのボーンにかかわらず、自身のウェイト",
        "无论另一身体有哪些骨骼，都用自身的权重",
    ),
    (
        'There is no body under most of "{0}": "{1}" has no surface there. Pick the whole body as the Source, or take '
        "the item out."
    ): (
        (
            '"{0}"の大部分の下にボディがありません。"{1}"はそこに面がありません。ボディ全体をソースに選ぶか、アイテムを'
            "外してください。"
        ),
        '"{0}"的大部分下方没有身体："{1}"在那里没有表面。请选择完整的身体作为源，或移除该物品。',
    ),
    'There is no collection called "{0}".': ('"{0}"というコレクションはありません。', '没有名为"{0}"的集合。'),
    "Tight": ("ぴったり", "紧身"),
    "Trying poses": ("ポーズを試しています", "正在测试姿势"),
    "Wear": ("着せる", "穿戴"),
    "What becomes of the body where clothes cover it": (
        "服に覆われた部分のボディをどうするか",
        "被服装遮盖的身体如何处理",
    ),
    "Which weights the fitted items get": ("合わせたアイテムが得るウェイト", "适配后的物品使用哪种权重"),
    (
        "Write color attributes that show how far each vertex is from the skin, how far it was pushed, and where it is "
        "uncertain"
    ): (
        "各頂点の肌からの距離、押し出された量、不確かなところを示すカラー属性を書き込みます",
        "写入颜色属性，显示每个顶点与皮肤的距离、被推出的距离以及不确定之处",
    ),
    '"{0}" was fitted.': ('"{0}"を合わせました。', '已适配"{0}"。'),
    '"{0}" was fitted: {1}.': ('"{0}"を合わせました: {1}。', '已适配"{0}"：{1}。'),
    '"{0}" should be checked: {1}.': ('"{0}"を確認してください: {1}。', '请检查"{0}"：{1}。'),
    "kept the shape of {0}": ("{0}の形を保持", "保持{0}不变形"),
    "pushed {0} of it out of what is below": ("{0}を下のものの外へ押し出し", "将其{0}推出下方之物"),
    "laid onto the skin of the other body": ("相手の体の肌の上に配置", "置于另一身体的皮肤上"),
    "what is below still shows through {0} of it": ("下のものがまだ{0}で突き抜けています", "下方之物仍从其{0}处穿出"),
    "the match is uncertain below {0} of it": ("その{0}の下でマッチングが不確かです", "其{0}下方的匹配不确定"),
    "the body ends below {0} of it": ("その{0}の下には体がありません", "其{0}下方没有身体"),
    '"{0}" counts as part of the body as well: "{1}" has no skin below it.': (
        '"{1}"には"{0}"の下に肌がないので、"{0}"も体の一部とみなします。',
        '"{0}"也被当作身体的一部分："{1}"在它下面没有皮肤。',
    ),
    'Weights of {0} of "{1}" were mended for poses.': (
        'ポーズのために"{1}"の{0}のウェイトを直しました。',
        '已为姿势修正"{1}"的{0}的权重。',
    ),
    '{0} of "{1}" were lifted off the skin for poses.': (
        'ポーズのために"{1}"の{0}を肌から浮かせました。',
        '已为姿势将"{1}"的{0}从皮肤上抬起。',
    ),
    "1 item": ("1個のアイテム", "1件物品"),
    "{0} items": ("{0}個のアイテム", "{0}件物品"),
    "{0} more": ("ほか{0}個", "另有 {0} 个"),
    "Select the clothes of the source, or bind them to its armature.": (
        "ソースの服を選択するか、そのアーマチュアにバインドしてください。",
        "请选择源的服装，或将其绑定到源的骨架。",
    ),
    "1 rigid part": ("1個の硬いパーツ", "1个刚性部件"),
    "{0} rigid parts": ("{0}個の硬いパーツ", "{0}个刚性部件"),
    "Clothes": ("服", "服装"),
    'The rig of "{0}" has other bones, so the weights were taken from its skin.': (
        '"{0}"のリグにはほかのボーンがあるため、ウェイトは肌から取りました。',
        '"{0}"的绑定使用其他骨骼，因此权重取自其皮肤。',
    ),
    "Wrap and Morph": ("ラップとモーフ", "包裹与变形"),
    "Switch to Object Mode first": ("先にオブジェクトモードに切り替えてください", "请先切换到物体模式"),
    "Mirror": ("ミラー", "镜像"),
    "Pick Source and Target first": ("先にソースとターゲットを選んでください", "请先选取源和目标"),
    "There is no match yet": ("マッチングはまだありません", "还没有匹配"),
    "Which mesh is the Source is open: pick it in the panel, or make it the active object.": (
        "どのメッシュがソースなのかが決まりません。パネルで選ぶか、アクティブオブジェクトにしてください。",
        "无法确定哪个网格是源：请在面板中选取，或将其设为活动物体。",
    ),
    (
        'The collection "{0}" holds no mesh with faces that is shown in this view layer. Show its meshes, or choose '
        "another one."
    ): (
        (
            "コレクション「{0}」には、このビューレイヤーに表示されている面のあるメッシュがありません。メッシュを表示す"
            "るか、別のコレクションを選んでください。"
        ),
        "集合“{0}”中没有在此视图层中显示的带面网格。请显示其网格，或选择另一个集合。",
    ),
    (
        'The armature "{0}" moves no mesh with faces that is shown in this view layer. Show its meshes, or choose '
        "another one."
    ): (
        (
            "アーマチュア「{0}」は、このビューレイヤーに表示されている面のあるメッシュを動かしていません。メッシュを表"
            "示するか、別のアーマチュアを選んでください。"
        ),
        "骨架“{0}”没有驱动任何在此视图层中显示的带面网格。请显示其网格，或选择另一个骨架。",
    ),
    '"{0}" belongs to both Source and Target. Choose two characters that share no object.': (
        (
            "「{0}」はソースとターゲットの両方に属しています。同じオブジェクトを共有しない二つのキャラクターを選んでく"
            "ださい。"
        ),
        "“{0}”同时属于源和目标。请选择没有共同物体的两个角色。",
    ),
    (
        'All that is selected is moved by the same rig as "{0}": {1}. Select a mesh of another character, or pick the '
        "part as the Target in the panel if it is meant."
    ): (
        (
            "選択されているものは、すべて「{0}」と同じリグで動いています：{1}。別のキャラクターのメッシュを選択するか、"
            "その部分を対象にするならパネルでターゲットに選んでください。"
        ),
        "所选的全部与“{0}”由同一绑定驱动：{1}。请选择另一个角色的网格；如果确实要用该部件，请在面板中将其选为目标。",
    ),
    'What the rig of "{0}" moves as well was left alone: {1}.': (
        "「{0}」と同じリグで動くものは変更していません：{1}。",
        "与“{0}”由同一绑定驱动的部件未作更改：{1}。",
    ),
    "It is open which mesh is the Target. Pick it in the panel, or select one or more beside the Source.": (
        "どのメッシュがターゲットなのかが決まりません。パネルで選ぶか、ソースのほかに一つ以上選択してください。",
        "无法确定哪个网格是目标。请在面板中选取，或在源之外再选择一个或多个。",
    ),
    (
        "All kinds are switched off, so there is nothing to carry over. Switch on at least one: Rig, Weights, Shape "
        "Keys, UV Maps or Attributes."
    ): (
        (
            "すべての種類がオフなので、転送するものがありません。リグ、ウェイト、シェイプキー、UVマップ、属性のうち少な"
            "くとも一つをオンにしてください。"
        ),
        "所有种类都已关闭，因此没有可传递的内容。请至少打开一种：绑定、权重、形态键、UV 贴图或属性。",
    ),
    "Finding faces": ("面を探しています", "正在查找面"),
    "Carrying materials and normals": ("マテリアルと法線を転送しています", "正在传递材质和法向"),
    "The rig of the source was changed meanwhile. Nothing was written.": (
        "その間にソースのリグが変更されました。何も書き込まれていません。",
        "源的绑定在此期间被更改。未写入任何内容。",
    ),
    "Placing the joints": ("関節を配置しています", "正在放置关节"),
    "Finding the rest pose": ("レストポーズを求めています", "正在寻找静置姿态"),
    "No shape key is named. Enter the Names of some, separated by commas.": (
        "シェイプキーの名前がありません。「名前」にコンマで区切って入力してください。",
        "未指定形态键。请在“名称”中输入，用逗号分隔。",
    ),
    "Telling the sides apart": ("左右を区別しています", "正在区分两侧"),
    "Mirroring": ("ミラーしています", "正在镜像"),
    "No UV map is named. Enter the Names of some, separated by commas.": (
        "UVマップの名前がありません。「名前」にコンマで区切って入力してください。",
        "未指定 UV 贴图。请在“名称”中输入，用逗号分隔。",
    ),
    "Finding shapes in between": ("中間の形状を求めています", "正在寻找中间形状"),
    "The attributes of the stored map hold numbers that no match has written. Match again.": (
        "保存されたマップの属性に、マッチングが書き込んだものではない数値があります。再マッチングしてください。",
        "已存映射的属性中含有并非由匹配写入的数值。请重新匹配。",
    ),
    "The stored map is one of meshes with other vertices. Match again.": (
        "保存されたマップは頂点の異なるメッシュのものです。再マッチングしてください。",
        "已存映射属于顶点不同的网格。请重新匹配。",
    ),
    "No matching is possible: too many pairs of a point and a candidate are forbidden.": (
        "マッチングできません。ポイントと候補の組が多く禁止されすぎています。",
        "无法匹配：被禁止的点与候选组合过多。",
    ),
    "No triangle of the mesh has three different corners. Check its scale and its vertices.": (
        "三つの角がすべて異なる三角形がメッシュにありません。スケールと頂点を確認してください。",
        "网格中没有三个角各不相同的三角形。请检查其缩放和顶点。",
    ),
    "Nothing of the mesh has an area once repeated and degenerate faces are left out.": (
        "重複した面や縮退した面を除くと、メッシュに面積がなくなります。",
        "去除重复面和退化面之后，网格没有任何面积。",
    ),
    "A search along the surface starts at a vertex without a triangle. Delete loose vertices.": (
        "表面に沿った探索が、三角形のない頂点から始まっています。孤立した頂点を削除してください。",
        "沿表面的搜索始于没有三角形的顶点。请删除松散顶点。",
    ),
    "Some values at the corners of faces are not finite numbers. Repair them, or leave them out.": (
        "面コーナーの一部の値が有限の数ではありません。修復するか、除外してください。",
        "某些面拐上的值不是有限数。请修复或排除它们。",
    ),
    "Measuring distances": ("距離を計測しています", "正在测量距离"),
    "Judging the map": ("マップを評価しています", "正在评估映射"),
    "Mapping every vertex": ("すべての頂点をマップしています", "正在映射每个顶点"),
    "Bounding the best matching": ("最良のマッチングの限界を求めています", "正在求最佳匹配的界限"),
    "Tracing edges": ("辺をたどっています", "正在追踪边"),
    "Computing eigenfunctions": ("固有関数を計算しています", "正在计算特征函数"),
    "The faces use vertices that the map does not know. Match again.": (
        "マップにない頂点を面が使っています。再マッチングしてください。",
        "这些面使用了映射中没有的顶点。请重新匹配。",
    ),
    "Refining maps": ("マップを改良しています", "正在改善映射"),
    "Comparing maps": ("マップを比較しています", "正在比较映射"),
    "Placing the first points": ("最初のポイントを配置しています", "正在放置最初的点"),
    "Comparing matchings": ("マッチングを比較しています", "正在比较各匹配"),
    "No bone of the rig moves a vertex.": ("リグのどのボーンも頂点を動かしません。", "绑定中没有任何骨骼带动顶点。"),
    "The mesh has no vertices.": ("メッシュに頂点がありません。", "网格没有顶点。"),
    "The mesh has no faces. A surface is needed, not only vertices or edges.": (
        "メッシュに面がありません。頂点や辺だけでなく、表面が必要です。",
        "网格没有面。需要有表面，而不仅仅是顶点或边。",
    ),
    (
        "Every triangle of the mesh has zero area: the mesh has no surface. Check its scale and whether its vertices "
        "all lie on one line or in one point."
    ): (
        (
            "メッシュのすべての三角形の面積が0で、表面がありません。スケールと、頂点がすべて一直線上または一点にないか"
            "を確認してください。"
        ),
        "网格的每个三角形面积都为零：网格没有表面。请检查其缩放，以及顶点是否都在一条线上或一个点上。",
    ),
    "The faces of the mesh are not those that the map was made for. Match again.": (
        "メッシュの面が、マップを作ったときの面と異なります。再マッチングしてください。",
        "网格的面不是制作映射时的面。请重新匹配。",
    ),
    "A face has fewer than three corners. Repair the mesh.": (
        "角が三つ未満の面があります。メッシュを修復してください。",
        "有一个面少于三个角。请修复网格。",
    ),
    "Cleaning": ("クリーンアップしています", "正在清理"),
    (
        "Some points do not lie on the main part of the mesh, which is the one that is matched. Choose points on that "
        "part."
    ): (
        (
            "一部のポイントが、マッチングの対象であるメッシュの主要な部分にありません。その部分のポイントを選んでくださ"
            "い。"
        ),
        "某些点不在网格的主要部分上，而匹配的正是该部分。请在该部分上选择点。",
    ),
    "Landmark {number}": ("ランドマーク {number}", "地标 {number}"),
    "Point {number}, distortion {distortion}": (
        "ポイント {number}、歪み {distortion}",
        "点 {number}，畸变 {distortion}",
    ),
    "Preparing what is written": ("書き込む内容を準備しています", "正在准备要写入的内容"),
    "Cutting parts open that touch": ("接した部分を切り開いています", "正在切开相接的部分"),
    "Simplifying the mesh": ("メッシュを単純化しています", "正在简化网格"),
    "There are no landmarks to refine the map around. Name at least one pair of vertices.": (
        "マップを改良するためのランドマークがありません。少なくとも一組の頂点を指定してください。",
        "没有可用来改善映射的地标。请至少指定一对顶点。",
    ),
    "Fitting the surfaces": ("表面を合わせています", "正在拟合表面"),
    (
        "The match exchanges left and right, and would turn clothes inside out. Use another answer of the match, or "
        "match the bodies again."
    ): (
        (
            "マッチングは左右を入れ替えており、服が裏返しになります。マッチングの別の解を使うか、もう一度マッチングして"
            "ください。"
        ),
        "匹配交换了左右，会使衣物内外翻转。请使用匹配的另一个解，或重新匹配两个身体。",
    ),
    (
        "The match exchanges left and right, so bones would turn the wrong way. Use another answer of the match, or "
        "match the bodies again."
    ): (
        (
            "マッチングは左右を入れ替えており、ボーンが逆向きに回転します。マッチングの別の解を使うか、もう一度マッチン"
            "グしてください。"
        ),
        "匹配交换了左右，骨骼会朝错误的方向旋转。请使用匹配的另一个解，或重新匹配两个身体。",
    ),
    "No bone moves the main part of the source. Give it weights, or choose another source.": (
        "ソースの主要な部分を動かすボーンがありません。ウェイトを与えるか、別のソースを選んでください。",
        "没有骨骼带动源的主要部分。请为其添加权重，或选择其他源。",
    ),
    "Fitting the bones": ("ボーンを合わせています", "正在适配骨骼"),
    "The weights of the bones should be finite numbers that are not negative.": (
        "ボーンのウェイトは、負でない有限の数でなければなりません。",
        "骨骼的权重应为非负的有限数。",
    ),
    "Posing hands": ("手のポーズを合わせています", "正在调整手部姿态"),
    "Sliding": ("滑らせています", "正在滑动"),
    "Moving points over the surface": ("ポイントを表面上で動かしています", "正在沿表面移动各点"),
    "Finding regions without confidence": ("信頼度のない領域を探しています", "正在查找没有置信度的区域"),
    "A shape key of the source moves a vertex by what is not a finite number. Repair that key.": (
        "ソースのシェイプキーの一つが、有限の数でない量だけ頂点を動かしています。そのキーを修復してください。",
        "源的某个形态键移动顶点的量不是有限数。请修复该键。",
    ),
    "Carrying offsets": ("オフセットを転送しています", "正在传递偏移"),
    "The skeleton has a joint whose position is not a finite number.": (
        "骨格に、位置が有限の数でない関節があります。",
        "骨架中有一个关节的位置不是有限数。",
    ),
    "Some bones of the skeleton are their own ancestors.": (
        "骨格の一部のボーンが自分自身の祖先になっています。",
        "骨架中有些骨骼是自己的祖先。",
    ),
    (
        "Nothing tells the two sides apart. Give the vertex groups names that end in .L and .R, or move the object's "
        "origin so that its X axis points to the left side."
    ): (
        (
            "左右を区別する手がかりがありません。頂点グループに.Lと.Rで終わる名前を付けるか、X軸が左側を指すようにオブ"
            "ジェクトの原点を動かしてください。"
        ),
        "没有什么能区分两侧。请为顶点组使用以 .L 和 .R 结尾的名称，或移动物体原点，使其 X 轴指向左侧。",
    ),
    "The mesh is too coarse to be matched to anything but itself: use more Coarse Candidates or subdivide it.": (
        "メッシュが粗すぎて、自分自身以外にマッチングできません。「粗い候補」を増やすか、細分化してください。",
        "网格过于粗糙，只能与自身匹配：请使用更多粗匹配候选，或将其细分。",
    ),
    "Placing the points": ("ポイントを配置しています", "正在放置各点"),
    "Cutting islands": ("アイランドを切り出しています", "正在切分孤岛"),
    "Laying faces onto islands": ("面をアイランドに配置しています", "正在将面放到孤岛上"),
    "Carrying weights": ("ウェイトを転送しています", "正在传递权重"),
    "Joining pieces": ("ピースをつないでいます", "正在合并部件"),
    "Looking for missing parts": ("足りない部分を探しています", "正在查找缺失的部分"),
    "Looking for torn vertices": ("引き離された頂点を探しています", "正在查找撕开的顶点"),
    "Filling in weights": ("ウェイトを補充しています", "正在填充权重"),
    "The map does not hold the source anywhere on the target: the two are too different. Match them again.": (
        "マップはターゲットのどこにもソースを留められません。両者が違いすぎます。再マッチングしてください。",
        "映射无法将源固定在目标的任何位置：两者差异过大。请重新匹配。",
    ),
    "Placing parts that the target lacks": ("ターゲットにない部分を配置しています", "正在放置目标所缺的部分"),
    "Laying the surface onto the other": ("表面をもう一方に重ねています", "正在将表面贴到另一方"),
    "Coarse Match": ("粗いマッチング", "粗匹配"),
    "Left and Right": ("左右", "左右"),
    "Time": ("時間", "时间"),
    "none": ("なし", "无"),
    "kept": ("保持", "保持"),
    "finished": ("完了", "已完成"),
    "ended early, at most {gap} from the best": (
        "途中で終了。最良との差は最大{gap}",
        "提前结束，与最优解最多相差 {gap}",
    ),
    "unclear, see colors": ("不明。色を見て確かめてください", "不明确，请查看颜色"),
    "good": ("良好", "良好"),
    "fair": ("まずまず", "尚可"),
    "look closely": ("よく確かめてください", "请仔细检查"),
    "do not trust it": ("信頼できません", "不可信"),
    "little": ("わずか", "很小"),
    "some": ("いくらか", "有一些"),
    "much, the builds differ": ("大きい。体型が異なります", "较大，体型不同"),
    "very much": ("非常に大きい", "非常大"),
    "Search": ("探索", "搜索"),
    "Details": ("詳細", "详细信息"),
    "Options": ("オプション", "选项"),
    "Demo and Files": ("デモとファイル", "演示与文件"),
    "How distances are measured, and by what a place is recognised in another pose": (
        "距離の測り方と、別のポーズで場所を見分ける手がかり",
        "距离如何度量，以及在另一姿势中凭什么识别位置",
    ),
    "The first step: a few points, for which all combinations are looked through": (
        "最初の段階：少数の点について、すべての組み合わせを調べます",
        "第一步：对少量点检查所有组合",
    ),
    "The steps after: more points, each sought near where those around it lie": (
        "次の段階：点を増やし、それぞれを周りの点の近くで探します",
        "后续步骤：增加更多点，并在周围各点附近寻找",
    ),
    "exchanged": ("入れ替わり", "互换"),
    "{count} points matched": ("{count}個のポイントをマッチングしました", "已匹配 {count} 个点"),
    "Custom": ("カスタム", "自定义"),
    "Metric and Descriptor": ("距離と記述子", "度量与描述符"),
    "Refinement": ("改良", "改善"),
    "The match was cancelled. Nothing was written": (
        "マッチングはキャンセルされました。何も書き込まれていません",
        "匹配已取消。未写入任何内容",
    ),
    "It was cancelled. Nothing was written": (
        "キャンセルされました。何も書き込まれていません",
        "已取消。未写入任何内容",
    ),
    "It was cancelled. The match is as it was": (
        "キャンセルされました。マッチングは元のままです",
        "已取消。匹配保持原样",
    ),
    "It was cancelled. No landmark was added": (
        "キャンセルされました。ランドマークは追加されていません",
        "已取消。未添加地标",
    ),
    "There is no alternative {0}, only {1}: the direct answer was written.": (
        "代替解{0}はありません({1}個だけです)。直接の解を書き込みました。",
        "没有替代解 {0}，只有 {1} 个：已写入直接解。",
    ),
    "The map turns large parts of the surface over: do not trust it; try landmarks.": (
        "マップが表面の大きな部分を裏返しています。信頼せず、ランドマークを試してください。",
        "映射将表面的大片区域翻转：不可信，请尝试使用地标。",
    ),
    "The shapes have little in common: limbs were taken for the same that both rigs have in the same places.": (
        "形状の共通点がわずかです: 両方のリグが同じ位置に持つ手足などを対応するものとみなしました。",
        "两个形状共同点很少：双方骨架在相同位置都有的肢体被视为彼此对应。",
    ),
    "The shapes have little in common: the ends of their limbs were taken for the same where both stand alike.": (
        "形状の共通点がわずかです: 両方が同じように立っているので、手足などの先端を対応するものとみなしました。",
        "两个形状共同点很少：两者站姿相似，因此把肢体末端视为彼此对应。",
    ),
    "The shapes have too little in common: leave out what only one of them has, or try landmarks.": (
        "形状の共通点が少なすぎます。片方にしかない部分を除外するか、ランドマークを試してください。",
        "两个形状的共同点太少：请排除只有其中一个才有的部分，或尝试使用地标。",
    ),
    "{0} maps are about as likely: choose another answer if this one is wrong, or add a landmark.": (
        "{0}個のマップが同じくらい有力です。これが誤っていれば別の解を選ぶか、ランドマークを追加してください。",
        "{0} 个映射的可能性差不多：如果这个有误，请选择另一个解，或添加一个地标。",
    ),
    "{0} maps are about as likely by their shape, and this one leaves all in place: check it.": (
        "形状だけなら{0}個のマップが同じくらい有力で、このマップはすべてを元の位置に保ちます。確認してください。",
        "按形状有 {0} 个映射的可能性差不多，这个让一切保持原位：请检查。",
    ),
    "Another map was almost as likely: check the sides and each limb, and add a landmark if one is wrong.": (
        "別のマップもほぼ同じくらい有力でした。左右と手足を確認し、誤っていればランドマークを追加してください。",
        "另一个映射几乎同样可能：请检查左右和各个肢体，如果有误，请添加一个地标。",
    ),
    "The shapes differ much: the map is a good guess that keeps left and right, but details may slide.": (
        "形状が大きく異なります。マップは左右を保ったよい推測ですが、細部はずれているかもしれません。",
        "形状差异很大：映射是一个保持左右的良好估计，但细节可能滑移。",
    ),
    "The shapes correspond, with some stretching where they differ.": (
        "形状は対応しています。異なる部分では多少の伸縮があります。",
        "形状相互对应，在有差异之处有些拉伸。",
    ),
    "The shapes correspond closely.": ("形状はよく対応しています。", "形状紧密对应。"),
    "HierMatch Presets": ("HierMatchプリセット", "HierMatch 预设"),
    "Add HierMatch Preset": ("HierMatchプリセットを追加", "添加 HierMatch 预设"),
    "Save the options of Match and Retarget as a preset, or remove one that was saved": (
        "「マッチング」と「リターゲット」のオプションをプリセットとして保存するか、保存したものを削除します",
        "将匹配和重定向的选项保存为预设，或移除已保存的预设",
    ),
    "Name": ("名前", "名称"),
    "Name of the preset, of which its file is named": (
        "プリセットの名前。ファイル名にもなります",
        "预设的名称，也用作其文件名",
    ),
    "Remove by Name": ("名前で削除", "按名称移除"),
    "Remove the preset of that name instead of saving one": (
        "保存する代わりに、その名前のプリセットを削除します",
        "移除该名称的预设，而不是保存",
    ),
    "Remove Active": ("アクティブを削除", "移除活动项"),
    "Remove the preset that was chosen last instead of saving one": (
        "保存する代わりに、最後に選んだプリセットを削除します",
        "移除上次选择的预设，而不是保存",
    ),
    "Check Existing": ("上書きチェック", "检查是否存在"),
    "Fast Preview": ("高速プレビュー", "快速预览"),
    "Two-Legged Characters": ("二足キャラクター", "双足角色"),
    "Creatures": ("クリーチャー", "生物"),
    "Scans": ("スキャン", "扫描"),
    "{0}: {1}, {2}    Esc: cancel": ("{0}：{1}、{2}    Esc：キャンセル", "{0}：{1}，{2}    Esc：取消"),
    "Matching": ("マッチング中", "正在匹配"),
    "Refining": ("改良中", "正在改进"),
    "Retargeting": ("リターゲット中", "正在重定向"),
    "Symmetrising": ("対称化中", "正在对称化"),
    "Carrying over": ("引き継ぎ中", "正在传递"),
    "Mirroring landmarks": ("ランドマークを反転中", "正在镜像地标"),
    "Writing another answer": ("別の解を書き込み中", "正在写入另一个解"),
    "Exact search, {0} nodes": ("厳密探索、{0}ノード", "精确搜索，{0} 个节点"),
    "Matching {0} points": ("{0}個のポイントをマッチング中", "正在匹配 {0} 个点"),
    "Moving {0} points over the surface": ("{0}個のポイントを表面上で移動中", "正在表面上移动 {0} 个点"),
    "{0}    Landmarks added: {1}    Enter: done    Esc: back": (
        "{0}    追加したランドマーク：{1}    Enter：完了    Esc：戻る",
        "{0}    已添加地标：{1}    Enter：完成    Esc：返回",
    ),
    'Click on a place of "{0}" or "{1}"': ("「{0}」か「{1}」の場所をクリック", "点击“{0}”或“{1}”上的一处"),
    'Click on the corresponding place of "{0}"': ("「{0}」の対応する場所をクリック", "点击“{0}”上的对应位置"),
    "The shapes correspond, but for a small part of the target ({0}) that the other lacks.": (
        "形状は対応していますが、ターゲットの小さな一部（{0}）がソースにありません。",
        "两个形状相对应，只有目标的一小部分（{0}）在源上不存在。",
    ),
    "The shapes correspond, but for a small part of the source ({0}) that the other lacks.": (
        "形状は対応していますが、ソースの小さな一部（{0}）がターゲットにありません。",
        "两个形状相对应，只有源的一小部分（{0}）在目标上不存在。",
    ),
    "Only {0} of the target is reached: {1}": ("ターゲットの{0}にしか届いていません。{1}", "只覆盖了目标的 {0}：{1}"),
    "The shapes overlap: {0} of the source and {1} of the target have a partner.": (
        "形状は一部で重なっています。ソースの{0}とターゲットの{1}に対応する場所があります。",
        "两个形状部分重叠：源的 {0} 和目标的 {1} 有对应位置。",
    ),
    "It is not clear what the shapes share: do not trust the map; add landmarks, or cut them alike.": (
        (
            "形状のどこが共通なのかはっきりしません。このマップは信頼せず、ランドマークを追加するか、同じように切り取っ"
            "てください。"
        ),
        "不清楚两个形状共有哪些部分：请不要信任该映射；请添加地标，或把它们裁成相同的部分。",
    ),
    "Only {0} of the source has a partner: {1}": (
        "ソースの{0}にしか対応する場所がありません。{1}",
        "源只有 {0} 有对应位置：{1}",
    ),
    "Separate pieces, {0} of a mesh, have no counterpart on the other: check where they went.": (
        (
            "メッシュの{0}を占める独立したパーツに、もう一方のメッシュで対応するパーツがありません。行き先を確認してく"
            "ださい。"
        ),
        "占网格 {0} 的独立部件在另一个网格上没有对应部件：请检查它们的去向。",
    ),
    "parts of one shape seem to be missing on the other.": (
        "一方の形状の一部がもう一方にないようです。",
        "一个形状的某些部分似乎在另一个上不存在。",
    ),
    "The {0} hangs together where the {1} does not: it was cut open there for matching.": (
        "{0}には{1}にないつながりがあるため、マッチングのためにそこを切り開きました。",
        "{0}在{1}没有相连的地方连在一起：已为匹配将其切开。",
    ),
    "Matched {0} points of {1} in {2} s": (
        "{1}の{0}個のポイントを{2}秒でマッチングしました",
        "在 {2} 秒内匹配了 {1} 的 {0} 个点",
    ),
    "Matched {0} points of {1} in {2} s. {3}": (
        "{1}の{0}個のポイントを{2}秒でマッチングしました。{3}",
        "在 {2} 秒内匹配了 {1} 的 {0} 个点。{3}",
    ),
    '"{0}" and "{1}"': ("「{0}」と「{1}」", "“{0}”和“{1}”"),
    "Refined the match in {0} s. {1}": ("マッチングを{0}秒で改良しました。{1}", "在 {0} 秒内改进了匹配。{1}"),
    'Wrote the {0} match of "{1}" and "{2}"': (
        "「{1}」と「{2}」の{0}マッチングを書き込みました",
        "已写入“{1}”和“{2}”的{0}匹配",
    ),
    "direct": ("直接の", "直接"),
    "mirrored": ("ミラー", "镜像"),
    "turned {0}": ("回転{0}の", "旋转 {0}"),
    "Wrote {0} regions on both meshes as vertex groups": (
        "両メッシュに{0}個の領域を頂点グループとして書き込みました",
        "已在两个网格上把 {0} 个区域写为顶点组",
    ),
    'Exported the match of "{0}" and "{1}" to "{2}"': (
        "「{0}」と「{1}」の対応を「{2}」に書き出しました",
        "已将“{0}”和“{1}”的匹配导出到“{2}”",
    ),
    'Imported the match of "{0}" and "{1}" from "{2}"': (
        "「{0}」と「{1}」の対応を「{2}」から読み込みました",
        "已从“{2}”导入“{0}”和“{1}”的匹配",
    ),
    '"{0}" is hardly symmetric, so that its mirror images are uncertain (confidence {1}): check what was mirrored.': (
        (
            "「{0}」はほとんど左右対称ではないため、鏡像の位置は不確かです（信頼度{1}）。ミラーした結果を確認してくださ"
            "い。"
        ),
        "“{0}”几乎不对称，因此镜像位置不确定（置信度 {1}）：请检查镜像的结果。",
    ),
    "Nothing to mirror: all landmarks lie in the middle, or have one on the other side already": (
        "ミラーするものがありません。すべてのランドマークは中央にあるか、反対側にすでにあります",
        "没有可镜像的地标：所有地标都位于中间，或另一侧已有对应地标",
    ),
    "Added {0} on the other side": ("反対側に{0}を追加しました", "已在另一侧添加 {0}"),
    "Cleared {0}": ("{0}をクリアしました", "已清除 {0}"),
    "Setup: {0}": ("設定：{0}", "设置：{0}"),
    'Made "{0}" symmetric in {1} s: {2}': ("「{0}」を{1}秒で対称にしました：{2}", "在 {1} 秒内使“{0}”对称：{2}"),
    'Carried to "{0}" in {1} s: {2}': ("「{0}」に{1}秒で引き継ぎました：{2}", "在 {1} 秒内传递到“{0}”：{2}"),
    'Found for "{0}" in {1} s: {2}': ("「{0}」について{1}秒で見つけました：{2}", "在 {1} 秒内为“{0}”找到：{2}"),
    'There is no object called "{0}".': ("「{0}」という名前のオブジェクトはありません。", "没有名为“{0}”的物体。"),
    (
        "It is open which mesh is the {0}: {1}. Select exactly two meshes (the active one is the Source), or pick "
        "Source and Target in the panel."
    ): (
        (
            "どのメッシュが{0}か決まりません（{1}）。メッシュをちょうど二つ選択するか（アクティブな方がソース）、パネル"
            "でソースとターゲットを選んでください。"
        ),
        "无法确定哪个网格是{0}（{1}）。请正好选择两个网格（活动的是源），或在面板中选取源和目标。",
    ),
    "no other mesh is selected": ("ほかのメッシュが選択されていません", "没有选中其他网格"),
    "{0} other meshes are selected": ("ほかに{0}個のメッシュが選択されています", "选中了另外 {0} 个网格"),
    'Source and Target are both "{0}". Choose two different objects.': (
        "ソースとターゲットがどちらも「{0}」です。別々のオブジェクトを選んでください。",
        "源和目标都是“{0}”。请选择两个不同的物体。",
    ),
    (
        '"{0}" and "{1}" share the same mesh data. Give one of them its own first (Object > Relations > Make Single '
        "User > Object & Data)."
    ): (
        (
            "「{0}」と「{1}」は同じメッシュデータを共有しています。先に一方を独立させてください（オブジェクト > 関係 > "
            "シングルユーザー化 > オブジェクトとデータ）。"
        ),
        "“{0}”和“{1}”共用同一网格数据。请先让其中一个使用自己的数据（物体 > 关系 > 使其独立化 > 物体和数据）。",
    ),
    (
        '"{0}" is no mesh but shows the collection "{1}". Make its objects editable (Object > Library Override > Make, '
        "or Object > Apply > Make Instances Real), and choose one of them."
    ): (
        (
            "「{0}」はメッシュではなく、コレクション「{1}」を表示しているものです。その中のオブジェクトを編集可能にして"
            "（オブジェクト > ライブラリオーバーライド > 作成、または オブジェクト > 適用 > インスタンスを実体化）、そ"
            "のうちの一つを選んでください。"
        ),
        (
            "“{0}”不是网格，而是显示集合“{1}”的实例。请先使其中的物体可编辑（物体 > 库重写 > 创建，或 物体 > 应用 > 使"
            "实例独立），然后选择其中之一。"
        ),
    ),
    '"{0}" is not a mesh but of type {1}. Choose a mesh object, or convert it (Object > Convert > Mesh).': (
        (
            "「{0}」はメッシュではなく{1}タイプです。メッシュオブジェクトを選ぶか、変換してください（オブジェクト > 変"
            "換 > メッシュ）。"
        ),
        "“{0}”不是网格，而是 {1} 类型。请选择网格物体，或将其转换（物体 > 转换 > 网格）。",
    ),
    '"{0}" is in no scene any more.': ("「{0}」はもうどのシーンにもありません。", "“{0}”已不在任何场景中。"),
    '"{0}" is not in the view layer "{1}". Link it to the scene, or enable its collection in the Outliner.': (
        (
            "「{0}」はビューレイヤー「{1}」にありません。シーンにリンクするか、アウトライナーでコレクションを有効にして"
            "ください。"
        ),
        "“{0}”不在视图层“{1}”中。请将其链接到场景，或在大纲视图中启用它的集合。",
    ),
    '"{0}" is hidden. Show it first (Object > Show/Hide, or the eye in the Outliner).': (
        "「{0}」は非表示です。先に表示してください（オブジェクト > 表示/隠す、またはアウトライナーの目のアイコン）。",
        "“{0}”已隐藏。请先显示它（物体 > 显示/隐藏，或大纲视图中的眼睛图标）。",
    ),
    (
        '"{0}" is not shown: its collection is hidden or disabled in viewports, or it is outside of Local View. Show '
        "its collection in the Outliner, or leave Local View (View > Local View)."
    ): (
        (
            "「{0}」は表示されていません。コレクションが非表示またはビューポートで無効か、ローカルビューの外にあります"
            "。アウトライナーでコレクションを表示するか、ローカルビューを終了してください（ビュー > ローカルビュー）。"
        ),
        (
            "“{0}”未显示：其集合已隐藏或在视图中禁用，或者它在局部视图之外。请在大纲视图中显示其集合，或退出局部视图（"
            "视图 > 局部视图）。"
        ),
    ),
    '"{0}" is disabled in viewports. Enable it with the screen beside its name in the Outliner.': (
        (
            "「{0}」はビューポートで無効になっています。アウトライナーで名前の横にある画面アイコンを押して有効にしてく"
            "ださい。"
        ),
        "“{0}”已在视图中禁用。请在大纲视图中点击名称旁的屏幕图标启用它。",
    ),
    '"{0}" is in {1} Mode. Switch to Object Mode first.': (
        "「{0}」は{1}モードです。先にオブジェクトモードに切り替えてください。",
        "“{0}”处于 {1} 模式。请先切换到物体模式。",
    ),
    '"{0}" shares its mesh with an object in Edit Mode. Switch to Object Mode there first.': (
        (
            "「{0}」は編集モードのオブジェクトとメッシュを共有しています。先にそちらをオブジェクトモードに切り替えてく"
            "ださい。"
        ),
        "“{0}”与处于编辑模式的物体共用网格。请先在那里切换到物体模式。",
    ),
    '"{0}" has no faces. A surface is needed, not only vertices or edges.': (
        "「{0}」には面がありません。頂点や辺だけでなく、面が必要です。",
        "“{0}”没有面。需要表面，而不只是顶点或边。",
    ),
    '"{0}" has a scale of zero on {1}. Set its scale to 1 (Alt+S).': (
        "「{0}」の{1}のスケールが0です。スケールを1にしてください（Alt+S）。",
        "“{0}”在 {1} 上的缩放为零。请将缩放设为 1（Alt+S）。",
    ),
    (
        '"{0}" is linked from "{1}" and cannot be written to. Make object and data local first (Object > Relations > '
        "Make Local). As the Source of Retarget, Wear and Motion it can stay as it is."
    ): (
        (
            "「{0}」は「{1}」からリンクされており、書き込めません。先にオブジェクトとデータをローカル化してください（オ"
            "ブジェクト > 関係 > ローカル化）。リターゲット、着せる、モーションのソースとしてはそのままで使えます。"
        ),
        (
            "“{0}”链接自“{1}”，无法写入。请先将物体和数据本地化（物体 > 关系 > 本地化）。作为重定向、穿戴和运动的源时可"
            "以保持原样。"
        ),
    ),
    (
        '"{0}" is a library override and cannot be written to. Make object and data local first (Object > Relations > '
        "Make Local). As the Source of Retarget, Wear and Motion it can stay as it is."
    ): (
        (
            "「{0}」はライブラリオーバーライドで、書き込めません。先にオブジェクトとデータをローカル化してください（オ"
            "ブジェクト > 関係 > ローカル化）。リターゲット、着せる、モーションのソースとしてはそのままで使えます。"
        ),
        (
            "“{0}”是库重写，无法写入。请先将物体和数据本地化（物体 > 关系 > 本地化）。作为重定向、穿戴和运动的源时可以"
            "保持原样。"
        ),
    ),
    (
        '"{0}" has no surface: each of its faces uses a vertex twice. Repair the mesh (in Edit Mode: Mesh > Clean Up > '
        "Degenerate Dissolve)."
    ): (
        (
            "「{0}」には表面がありません。どの面も同じ頂点を二度使っています。メッシュを修復してください（編集モード："
            "メッシュ > クリーンアップ > 縮退の溶解）。"
        ),
        "“{0}”没有表面：每个面都重复使用了同一顶点。请修复网格（编辑模式：网格 > 清理 > 简并融并）。",
    ),
    (
        'The modifiers of "{0}" change its vertices from {1} to {2} ({3}). Apply or disable these modifiers, or turn '
        "Use Modifiers off."
    ): (
        (
            "「{0}」のモディファイアーが頂点数を{1}から{2}に変えています（{3}）。これらを適用または無効にするか、モディ"
            "ファイアーの使用をオフにしてください。"
        ),
        "“{0}”的修改器使顶点数从 {1} 变为 {2}（{3}）。请应用或禁用这些修改器，或关闭使用修改器。",
    ),
    (
        "{0} of {1} vertices have a position that is not a finite number, vertex {2} first. Delete these vertices or "
        "repair them."
    ): (
        (
            "{1}個の頂点のうち{0}個の位置が有限の数ではありません（最初は頂点{2}）。これらの頂点を削除または修復してく"
            "ださい。"
        ),
        "{1} 个顶点中有 {0} 个的位置不是有限数（首先是顶点 {2}）。请删除或修复这些顶点。",
    ),
    '"{0}" has {1} vertices, too few for {2} Points. Set Points to {3} or fewer, or subdivide the mesh.': (
        (
            "「{0}」の頂点は{1}個で、ポイント{2}個には足りません。ポイントを{3}以下にするか、メッシュを細分化してくださ"
            "い。"
        ),
        "“{0}”只有 {1} 个顶点，不够 {2} 个点。请将点数设为 {3} 或更少，或细分网格。",
    ),
    'The faces of "{0}" changed while it was being matched. Nothing was written.': (
        "マッチング中に「{0}」の面が変わりました。何も書き込んでいません。",
        "匹配期间“{0}”的面发生了变化。没有写入任何内容。",
    ),
    "The match was ended, because the objects changed: {0}": (
        "オブジェクトが変わったため、マッチングを終了しました：{0}",
        "因为物体发生了变化，匹配已结束：{0}",
    ),
    '"{0}" got another number of vertices while it was being matched. Nothing was written.': (
        "マッチング中に「{0}」の頂点数が変わりました。何も書き込んでいません。",
        "匹配期间“{0}”的顶点数发生了变化。没有写入任何内容。",
    ),
    'The match is out of date: "{0}" was edited since ({1}). Match again.': (
        "マッチングが古くなっています。「{0}」がその後編集されました（{1}）。もう一度マッチングしてください。",
        "匹配已过期：“{0}”之后被编辑过（{1}）。请重新匹配。",
    ),
    "it has other vertices or faces": ("頂点か面が異なります", "顶点或面不同"),
    "its vertices were moved": ("頂点が動かされました", "顶点被移动"),
    "it was mirrored": ("ミラーされました", "它被镜像"),
    'The match is out of date: "{0}" was cleared or matched anew. Match again.': (
        "マッチングが古くなっています。「{0}」がクリアまたは再マッチングされました。もう一度マッチングしてください。",
        "匹配已过期：“{0}”已被清除或重新匹配。请重新匹配。",
    ),
    'The match is out of date: "{0}" was deleted.': (
        "マッチングが古くなっています。「{0}」が削除されました。",
        "匹配已过期：“{0}”已被删除。",
    ),
    '"{0}" carries no match. Match it first.': (
        "「{0}」にはマッチングがありません。先にマッチングしてください。",
        "“{0}”没有匹配。请先匹配。",
    ),
    '"{0}" carries no match with the Prefix "{1}". Match it first.': (
        "「{0}」には接頭辞「{1}」のマッチングがありません。先にマッチングしてください。",
        "“{0}”没有前缀为“{1}”的匹配。请先匹配。",
    ),
    '"{0}" carries several matches. Name the Prefix of one of them: {1}.': (
        "「{0}」には複数のマッチングがあります。いずれかの接頭辞を指定してください：{1}。",
        "“{0}”有多个匹配。请指定其中一个的前缀：{1}。",
    ),
    (
        'The {0} of this match, "{1}", was deleted, or renamed and cleared, or is not in the view layer "{2}". Bring '
        "it back, or match again."
    ): (
        (
            "このマッチングの{0}「{1}」は削除されたか、名前を変えてからクリアされたか、ビューレイヤー「{2}」にありませ"
            "ん。戻すか、もう一度マッチングしてください。"
        ),
        "此匹配的{0}“{1}”已被删除，或在改名后被清除，或不在视图层“{2}”中。请将其恢复，或重新匹配。",
    ),
    "Several objects are copies of the {0} of this match: {1}. Match the two again.": (
        "このマッチングの{0}のコピーが複数あります：{1}。二つをもう一度マッチングしてください。",
        "多个物体是此匹配的{0}的副本：{1}。请重新匹配两者。",
    ),
    '"{0}" does not carry this match any more, because it was cleared or matched anew. Match the two again.': (
        (
            "「{0}」はクリアまたは再マッチングされたため、このマッチングを持っていません。二つをもう一度マッチングして"
            "ください。"
        ),
        "“{0}”已被清除或重新匹配，不再带有此匹配。请重新匹配两者。",
    ),
    '"{0}" was deleted, cleared or matched anew meanwhile. Nothing was written.': (
        "その間に「{0}」が削除、クリア、または再マッチングされました。何も書き込んでいません。",
        "在此期间“{0}”被删除、清除或重新匹配。没有写入任何内容。",
    ),
    '"{0}" was edited meanwhile. Nothing was written.': (
        "その間に「{0}」が編集されました。何も書き込んでいません。",
        "在此期间“{0}”被编辑。没有写入任何内容。",
    ),
    '"{0}" was deleted meanwhile. Nothing was written.': (
        "その間に「{0}」が削除されました。何も書き込んでいません。",
        "在此期间“{0}”被删除。没有写入任何内容。",
    ),
    "source": ("ソース", "源"),
    "target": ("ターゲット", "目标"),
    (
        '"{0}" has other vertices or faces than when it was matched, so the stored match does not fit it any more. '
        "Match again."
    ): (
        (
            "「{0}」の頂点か面がマッチング時と異なるため、保存されたマッチングは合いません。もう一度マッチングしてくだ"
            "さい。"
        ),
        "“{0}”的顶点或面与匹配时不同，保存的匹配不再适用。请重新匹配。",
    ),
    'The match of "{0}" and "{1}" has no mirrored answer and no other: the meshes are not symmetric enough for one.': (
        "「{0}」と「{1}」のマッチングにはミラー解も他の解もありません。メッシュが十分に対称ではないためです。",
        "“{0}”和“{1}”的匹配没有镜像解，也没有其他解：网格不够对称。",
    ),
    "Use Landmarks is off, so there is nothing to refine around. Turn it on under Options.": (
        "「ランドマークを使用」がオフなので、改良の基準がありません。「オプション」でオンにしてください。",
        "使用地标已关闭，因此没有可供改善的依据。请在选项中将其打开。",
    ),
    'The match of "{0}" and "{1}" has the alternatives 1 to {2} only.': (
        "「{0}」と「{1}」のマッチングにある代替解は1から{2}までだけです。",
        "“{0}”和“{1}”的匹配只有替代解 1 到 {2}。",
    ),
    "{0} have no landmarks that are on. Add some where the match is wrong, and lock points where it is right.": (
        (
            "{0}にはオンのランドマークがありません。マッチングが誤っている所に追加し、正しい所のポイントをロックしてく"
            "ださい。"
        ),
        "{0} 没有启用的地标。请在匹配错误处添加一些，并在正确处锁定点。",
    ),
    "The match of {0} has no dense map to refine. Match them again with Dense Map on.": (
        "{0}のマッチングには改良する密なマップがありません。密なマップをオンにしてもう一度マッチングしてください。",
        "{0} 的匹配没有可改进的稠密映射。请启用稠密映射重新匹配。",
    ),
    (
        '"{0}" carries no colors called "{1}". Match again with {2} on under Output, and for confidence with Dense Map '
        "on."
    ): (
        (
            "「{0}」には「{1}」というカラーがありません。出力で{2}をオンにし、信頼度には密なマップもオンにして、もう一"
            "度マッチングしてください。"
        ),
        "“{0}”没有名为“{1}”的颜色。请在输出下启用{2}（置信度还需启用稠密映射）后重新匹配。",
    ),
    '"{0}" already has {1} called "{2}" that HierMatch did not write. Rename it.': (
        "「{0}」には、HierMatchが書き込んだものではない{1}「{2}」があります。名前を変えてください。",
        "“{0}”已有并非由 HierMatch 写入的{1}“{2}”。请将其重命名。",
    ),
    '"{0}" already has {1} called "{2}" that HierMatch did not write. Rename it, or choose another Prefix.': (
        (
            "「{0}」には、HierMatchが書き込んだものではない{1}「{2}」があります。名前を変えるか、別の接頭辞を選んでくだ"
            "さい。"
        ),
        "“{0}”已有并非由 HierMatch 写入的{1}“{2}”。请将其重命名，或选择另一个前缀。",
    ),
    (
        '"{0}" already has {1} called "{2}", which belongs to the match with the Prefix "{3}". Choose another Prefix, '
        "or clear that match."
    ): (
        (
            "「{0}」の{1}「{2}」は接頭辞「{3}」のマッチングのものです。別の接頭辞を選ぶか、そのマッチングをクリアしてく"
            "ださい。"
        ),
        "“{0}”的{1}“{2}”属于前缀为“{3}”的匹配。请选择另一个前缀，或清除那个匹配。",
    ),
    "a vertex group": ("頂点グループ", "顶点组"),
    "a custom property": ("カスタムプロパティ", "自定义属性"),
    "an attribute": ("属性", "属性"),
    (
        '"{0}" has no vertex group, boolean attribute, material or face set called "{1}", which is to be left out. '
        "Choose another one, or empty the field."
    ): (
        (
            "「{0}」には、除外する「{1}」という頂点グループ、ブーリアン属性、マテリアル、フェイスセットがありません。別"
            "のものを選ぶか、欄を空にしてください。"
        ),
        "“{0}”没有名为“{1}”的顶点组、布尔属性、材质或面组可供排除。请另选一个，或清空该栏。",
    ),
    'No vertex of "{0}" is in "{1}", which is to be left out. Assign vertices to it, or empty the field.': (
        "除外する「{1}」に「{0}」の頂点がありません。頂点を割り当てるか、欄を空にしてください。",
        "“{0}”没有顶点在要排除的“{1}”中。请为其指定顶点，或清空该栏。",
    ),
    'All of "{0}" is in "{1}", which is to be left out, so nothing remains to match. Choose a smaller region.': (
        (
            "「{0}」のすべてが除外する「{1}」に入っており、マッチングするものが残りません。もっと小さい領域を選んでくだ"
            "さい。"
        ),
        "“{0}”全部在要排除的“{1}”中，没有可匹配的部分。请选择更小的区域。",
    ),
    "Nothing of the {0} is left to match: all of its faces are left out.": (
        "{0}にマッチングするものが残っていません。すべての面が除外されています。",
        "{0}没有可匹配的部分：所有面都被排除了。",
    ),
    '"{0}" and "{1}" have no landmarks in common that are on. Add some first.': (
        "「{0}」と「{1}」には共通のオンのランドマークがありません。先に追加してください。",
        "“{0}”和“{1}”没有共同的已启用地标。请先添加。",
    ),
    '"{0}" and "{1}" have no landmarks in common. Add some first.': (
        "「{0}」と「{1}」には共通のランドマークがありません。先に追加してください。",
        "“{0}”和“{1}”没有共同的地标。请先添加。",
    ),
    '"{0}" and "{1}" have no landmark {2} in common.': (
        "「{0}」と「{1}」には共通のランドマーク{2}がありません。",
        "“{0}”和“{1}”没有共同的地标 {2}。",
    ),
    'Source and Target are both "{0}", or share the same mesh data. Choose two meshes of their own.': (
        "ソースとターゲットがどちらも「{0}」か、同じメッシュデータを共有しています。別々のメッシュを選んでください。",
        "源和目标都是“{0}”，或共用同一网格数据。请选择两个独立的网格。",
    ),
    '"{0}" is not a mesh. Pick two mesh objects as Source and Target.': (
        "「{0}」はメッシュではありません。ソースとターゲットにメッシュオブジェクトを選んでください。",
        "“{0}”不是网格。请选取两个网格物体作为源和目标。",
    ),
    '"{0}" is in {1} Mode. Leave it first.': (
        "「{0}」は{1}モードです。先にモードを抜けてください。",
        "“{0}”处于 {1} 模式。请先退出。",
    ),
    (
        'The modifiers of "{0}" show it far away from its own vertices. Disable them in the viewport, or select a '
        "vertex on each mesh in Edit Mode."
    ): (
        (
            "「{0}」はモディファイアーにより自身の頂点から離れて表示されています。ビューポートで無効にするか、編集モー"
            "ドで各メッシュの頂点を選択してください。"
        ),
        "“{0}”的修改器使其显示在远离自身顶点的位置。请在视图中禁用它们，或在编辑模式下在每个网格上选择一个顶点。",
    ),
    '"{0}" is not in Edit Mode. Select both meshes, enter Edit Mode, and select one vertex on each.': (
        (
            "「{0}」は編集モードではありません。両方のメッシュを選択して編集モードに入り、それぞれ頂点を一つ選択してく"
            "ださい。"
        ),
        "“{0}”不在编辑模式。请选择两个网格，进入编辑模式，并在每个上选择一个顶点。",
    ),
    '{0} vertices of "{1}" are selected. Select exactly one vertex on each of the two meshes.': (
        "「{1}」の{0}個の頂点が選択されています。二つのメッシュでそれぞれちょうど一つの頂点を選択してください。",
        "“{1}”选中了 {0} 个顶点。请在两个网格上各选择正好一个顶点。",
    ),
    "A mesh can have {0} landmarks. Remove some first.": (
        "メッシュに置けるランドマークは{0}個までです。先にいくつか削除してください。",
        "一个网格最多可有 {0} 个地标。请先移除一些。",
    ),
    '"{0}" has no vertex {1}: its vertices are numbered from 0 to {2}.': (
        "「{0}」に頂点{1}はありません。頂点の番号は0から{2}です。",
        "“{0}”没有顶点 {1}：顶点编号为 0 到 {2}。",
    ),
    '"{0}" and "{1}" carry no match with one another.': (
        "「{0}」と「{1}」の間にマッチングはありません。",
        "“{0}”和“{1}”之间没有匹配。",
    ),
    'Click on "{0}" or on "{1}".': ("「{0}」か「{1}」をクリックしてください。", "请点击“{0}”或“{1}”。"),
    'Landmark {0}: vertex {1} of "{2}" is vertex {3} of "{4}"': (
        "ランドマーク{0}：「{2}」の頂点{1}は「{4}」の頂点{3}です",
        "地标 {0}：“{2}”的顶点 {1} 对应“{4}”的顶点 {3}",
    ),
    "Removed landmark {0}": ("ランドマーク{0}を削除しました", "已移除地标 {0}"),
    "{0} had that in common with {1} as well": (
        "{0}と{1}にも共通していたランドマークです",
        "这也是 {0} 与 {1} 共有的地标",
    ),
    "Locked {0} as landmark {1}": ("{0}をランドマーク{1}としてロックしました", "已将 {0} 锁定为地标 {1}"),
    'Saved {0} to "{1}"': ("{0}を「{1}」に保存しました", "已将 {0}保存到“{1}”"),
    'Loaded {0} from "{1}"': ("{0}を「{1}」から読み込みました", "已从“{1}”加载 {0}"),
    (
        '"{0}" has other vertices or faces than when the landmarks were saved. They were put on the vertices where '
        "they had been."
    ): (
        "「{0}」の頂点か面がランドマークの保存時と異なります。ランドマークは元の位置の頂点に置きました。",
        "“{0}”的顶点或面与保存地标时不同。地标已放在原位置的顶点上。",
    ),
    (
        '"{0}" has no vertex of its own where landmark {1} of the file was. The file was saved for another mesh. '
        "Choose the right Source and Target."
    ): (
        (
            "「{0}」には、ファイルのランドマーク{1}の位置に固有の頂点がありません。別のメッシュ用のファイルです。正しい"
            "ソースとターゲットを選んでください。"
        ),
        "“{0}”在文件中地标 {1} 的位置没有单独的顶点。该文件是为另一个网格保存的。请选择正确的源和目标。",
    ),
    "{0} landmarks are more than the {1} points that are matched. Use more points or fewer landmarks.": (
        (
            "ランドマーク{0}個は、マッチングする{1}個のポイントより多すぎます。ポイントを増やすか、ランドマークを減らし"
            "てください。"
        ),
        "{0} 个地标多于要匹配的 {1} 个点。请增加点数或减少地标。",
    ),
    "Landmarks {0} and {1} are both at vertex {2} of the {3}. Use a vertex for one landmark only.": (
        "ランドマーク{0}と{1}が{3}の同じ頂点{2}にあります。一つの頂点にはランドマークを一つだけ置いてください。",
        "地标 {0} 和 {1} 都在{3}的顶点 {2} 上。一个顶点只能用于一个地标。",
    ),
    (
        "Landmark {0} is at vertex {1} of the {2}, which is not on its main part, the one that is matched. Choose a "
        "vertex on that part that is not left out."
    ): (
        (
            "ランドマーク{0}は{2}の頂点{1}にあり、マッチングされる主要な部分の上にありません。その部分で除外されていな"
            "い頂点を選んでください。"
        ),
        "地标 {0} 在{2}的顶点 {1} 上，不在要匹配的主要部分上。请选择该部分上未被排除的顶点。",
    ),
    "Landmarks {0} and {1} are at the same place of the {2}, at its vertices {3} and {4}. Remove one of them.": (
        "ランドマーク{0}と{1}は{2}の同じ場所（頂点{3}と{4}）にあります。一方を削除してください。",
        "地标 {0} 和 {1} 在{2}的同一位置（顶点 {3} 和 {4}）。请移除其中一个。",
    ),
    "{0} Coarse Points need at least as many Coarse Candidates, not {1}.": (
        "粗いポイント{0}個には、候補も同数以上必要です（現在{1}）。",
        "{0} 个粗匹配点至少需要同样多的粗匹配候选，而不是 {1} 个。",
    ),
    "{0} points cannot be matched: the {1} has only {2} vertices{3}. Use fewer points or subdivide the mesh.": (
        (
            "{0}個のポイントはマッチングできません。{1}の頂点は{2}個だけです{3}。ポイントを減らすか、メッシュを細分化し"
            "てください。"
        ),
        "无法匹配 {0} 个点：{1}只有 {2} 个顶点{3}。请减少点数或细分网格。",
    ),
    '"{0}" cannot be written: {1}. Choose another place.': (
        "「{0}」に書き込めません：{1}。別の場所を選んでください。",
        "无法写入“{0}”：{1}。请选择其他位置。",
    ),
    '"{0}" cannot be read: {1}. Choose another file.': (
        "「{0}」を読み込めません：{1}。別のファイルを選んでください。",
        "无法读取“{0}”：{1}。请选择其他文件。",
    ),
    '"{0}" cannot be read: {1}.': ("「{0}」を読み込めません：{1}。", "无法读取“{0}”：{1}。"),
    '"{0}" is no text. Choose a file that HierMatch has written.': (
        '"{0}"はテキストではありません。HierMatchが書き出したファイルを選んでください。',
        "“{0}”不是文本。请选择由 HierMatch 写出的文件。",
    ),
    '"{0}" is no name for a match file. Let it end with .npz or .json.': (
        "「{0}」は対応ファイルの名前ではありません。末尾を.npzか.jsonにしてください。",
        "“{0}”不是匹配文件的名称。请以 .npz 或 .json 结尾。",
    ),
    '"{0}" is no match that HierMatch has exported. Choose another file.': (
        "「{0}」はHierMatchが書き出した対応ではありません。別のファイルを選んでください。",
        "“{0}”不是 HierMatch 导出的匹配。请选择其他文件。",
    ),
    '"{0}" was exported by a later version of HierMatch. Update the add-on.': (
        "「{0}」は新しいバージョンのHierMatchで書き出されています。アドオンを更新してください。",
        "“{0}”由更新版本的 HierMatch 导出。请更新插件。",
    ),
    '"{0}" is damaged or no match file: {1}. Export the match again.': (
        "「{0}」は壊れているか、対応ファイルではありません：{1}。もう一度書き出してください。",
        "“{0}”已损坏或不是匹配文件：{1}。请重新导出匹配。",
    ),
    'The match fits the other way round: "{0}" is its source and "{1}" its target. Exchange the two.': (
        "このマッチングは逆向きです。「{0}」がソース、「{1}」がターゲットです。二つを入れ替えてください。",
        "匹配的方向相反：“{0}”是源，“{1}”是目标。请交换两者。",
    ),
    (
        'The match does not fit "{0}": it was exported from a mesh with {1} vertices, and this one has {2}. Choose the '
        "mesh it was made for, or match again."
    ): (
        (
            "マッチングが「{0}」に合いません。{1}頂点のメッシュから書き出されていますが、これは{2}頂点です。元のメッシ"
            "ュを選ぶか、もう一度マッチングしてください。"
        ),
        "匹配不适用于“{0}”：它导出自 {1} 个顶点的网格，而这个有 {2} 个。请选择原来的网格，或重新匹配。",
    ),
    (
        'The match does not fit "{0}": its vertices or faces are numbered otherwise than on the mesh the match was '
        "exported from. Choose that mesh, or match again."
    ): (
        (
            "マッチングが「{0}」に合いません。頂点か面の番号が書き出し元のメッシュと異なります。元のメッシュを選ぶか、"
            "もう一度マッチングしてください。"
        ),
        "匹配不适用于“{0}”：其顶点或面的编号与导出匹配的网格不同。请选择那个网格，或重新匹配。",
    ),
    "{0} carry several matches. Name the Prefix of one of them: {1}.": (
        "{0}には複数のマッチングがあります。いずれかの接頭辞を指定してください：{1}。",
        "{0} 有多个匹配。请指定其中一个的前缀：{1}。",
    ),
    "{0} carry no match with one another{1}. Match them first.": (
        "{0}の間に{1}マッチングはありません。先にマッチングしてください。",
        "{0} 之间没有{1}匹配。请先匹配。",
    ),
    "The match of {0} has no dense map. Match them again with Dense Map on.": (
        "{0}のマッチングには密なマップがありません。密なマップをオンにしてもう一度マッチングしてください。",
        "{0} 的匹配没有稠密映射。请启用稠密映射重新匹配。",
    ),
    'The match of "{0}" and "{1}" has no dense map. Match them with Dense Map on.': (
        "「{0}」と「{1}」のマッチングには密なマップがありません。密なマップをオンにしてマッチングしてください。",
        "“{0}”和“{1}”的匹配没有稠密映射。请启用稠密映射进行匹配。",
    ),
    "The dense map of {0} was removed from the attributes of a mesh. Match them again.": (
        "{0}の密なマップがメッシュの属性から削除されています。もう一度マッチングしてください。",
        "{0} 的稠密映射已从网格属性中移除。请重新匹配。",
    ),
    (
        '"{0}" shares its mesh with other objects, which would change with it. Give it its own mesh first (Object > '
        "Relations > Make Single User > Object & Data)."
    ): (
        (
            "「{0}」はほかのオブジェクトとメッシュを共有しており、それらも変わってしまいます。先に独立させてください（"
            "オブジェクト > 関係 > シングルユーザー化 > オブジェクトとデータ）。"
        ),
        "“{0}”与其他物体共用网格，它们也会随之改变。请先使其独立（物体 > 关系 > 使其独立化 > 物体和数据）。",
    ),
    '"{0}" is in Edit Mode. Switch to Object Mode first.': (
        "「{0}」は編集モードです。先にオブジェクトモードに切り替えてください。",
        "“{0}”处于编辑模式。请先切换到物体模式。",
    ),
    (
        '"{0}" has no armature, so there is no rig to fit. Give it an Armature modifier with its armature, or pick '
        "another Source."
    ): (
        (
            "「{0}」にはアーマチュアがなく、合わせるリグがありません。アーマチュアモディファイアーを付けるか、別のソー"
            "スを選んでください。"
        ),
        "“{0}”没有骨架，因此没有可适配的绑定。请为其添加骨架修改器，或选择另一个源。",
    ),
    (
        'No vertex of "{0}" is in a vertex group of a deforming bone of "{1}", so it is not known what the bones '
        "belong to. Bind the Source to its armature with weights first."
    ): (
        (
            "「{0}」のどの頂点も「{1}」の変形ボーンの頂点グループに入っておらず、ボーンの対応が決まりません。先にソース"
            "をウェイトでアーマチュアに関連付けてください。"
        ),
        "“{0}”没有顶点在“{1}”的变形骨骼的顶点组中，无法确定骨骼的归属。请先用权重将源绑定到骨架。",
    ),
    'The armature "{0}" has a scale of zero. Set its scale first.': (
        "アーマチュア「{0}」のスケールが0です。先にスケールを設定してください。",
        "骨架“{0}”的缩放为零。请先设置缩放。",
    ),
    'The armature "{0}" is mirrored by its scale. Apply that first (Object > Apply > Scale).': (
        "アーマチュア「{0}」はスケールで鏡像になっています。先に適用してください（オブジェクト > 適用 > スケール）。",
        "骨架“{0}”因缩放而被镜像。请先应用缩放（物体 > 应用 > 缩放）。",
    ),
    'The armature "{0}" is in Edit Mode. Switch to Object Mode first.': (
        "アーマチュア「{0}」は編集モードです。先にオブジェクトモードに切り替えてください。",
        "骨架“{0}”处于编辑模式。请先切换到物体模式。",
    ),
    '"{0}" has no vertex groups, so there are no weights to carry over. Choose a weighted mesh as the Source.': (
        "「{0}」には頂点グループがなく、引き継ぐウェイトがありません。ウェイトのあるメッシュをソースに選んでください。",
        "“{0}”没有顶点组，因此没有可传递的权重。请选择带权重的网格作为源。",
    ),
    (
        '"{0}" has no armature whose bones could tell which vertex groups to carry. Carry All of them, or add an '
        "Armature modifier."
    ): (
        (
            "「{0}」には、引き継ぐ頂点グループを決めるボーンを持つアーマチュアがありません。すべてを引き継ぐか、アーマ"
            "チュアモディファイアーを追加してください。"
        ),
        "“{0}”没有可用来确定要传递哪些顶点组的骨架。请传递全部，或添加骨架修改器。",
    ),
    'The active vertex group of "{0}" is one of a match. Select another one in its list of vertex groups.': (
        "「{0}」のアクティブな頂点グループはマッチングのものです。頂点グループのリストで別のものを選んでください。",
        "“{0}”的活动顶点组属于匹配。请在其顶点组列表中另选一个。",
    ),
    'All vertex groups to carry are locked on "{0}". Unlock some of them, or carry others.': (
        "引き継ぐ頂点グループは「{0}」ですべてロックされています。ロックを外すか、別のものを引き継いでください。",
        "要传递的顶点组在“{0}”上全部被锁定。请解锁一些，或传递其他的。",
    ),
    '"{0}" already has something else called "{1}". Rename it, or turn Mark Rejected off.': (
        "「{0}」には別の「{1}」がすでにあります。名前を変えるか、除外の印をオフにしてください。",
        "“{0}”已有其他名为“{1}”的内容。请将其重命名，或关闭标记剔除。",
    ),
    'Vertex groups of "{0}" for bones that move nothing of "{1}" were emptied: {2}.': (
        '"{1}"の何も動かさないボーンの"{0}"の頂点グループは空になりました: {2}。',
        '"{0}" 中不带动 "{1}" 任何部分的骨骼的顶点组已被清空：{2}。',
    ),
    'Weights of {0} of {1} were taken from their neighbors: the map leads them astray, far from these on "{2}".': (
        "{1}の{0}のウェイトは、マップが「{2}」上の離れた場所を指していたため、周囲から補いました。",
        "{1} 的 {0} 的权重由邻近部分补齐，因为映射在“{2}”上指向了远处。",
    ),
    '{0} of "{1}" was left out, because of values that are not finite numbers. Repair them.': (
        "「{1}」の{0}には有限の数でない値があるため、省かれました。値を修正してください。",
        "“{1}”的{0}含有不是有限数的值，因此被略去。请修复这些值。",
    ),
    'Locked shape keys of "{0}" were left alone: {1}.': (
        "「{0}」のロックされたシェイプキーはそのままにしました：{1}。",
        "“{0}”被锁定的形态键保持不变：{1}。",
    ),
    'Locked vertex groups of "{0}" were left alone: {1}.': (
        "「{0}」のロックされた頂点グループはそのままにしました：{1}。",
        "“{0}”被锁定的顶点组保持不变：{1}。",
    ),
    '"{0}" has no weights for the bones of "{1}" yet. Transfer the weights as well.': (
        "「{0}」にはまだ「{1}」のボーンのウェイトがありません。ウェイトも転送してください。",
        "“{0}”还没有“{1}”的骨骼权重。请同时传递权重。",
    ),
    'Constraints or drivers of "{0}" still point to {1}.': (
        "「{0}」のコンストレイントかドライバーはまだ{1}を指しています。",
        "“{0}”的约束或驱动器仍指向 {1}。",
    ),
    '"{0}" has no shape keys beside the basis, so there are none to carry over.': (
        "「{0}」にはベース以外のシェイプキーがなく、引き継ぐものがありません。",
        "“{0}”除基型外没有形态键，因此没有可传递的内容。",
    ),
    '"{0}" already has {1}, which was skipped.': (
        "「{0}」にはすでに{1}があるため、飛ばしました。",
        "“{0}”已有 {1}，已跳过。",
    ),
    '"{0}" has no UV map to carry over. Unwrap it, or choose another Source.': (
        "「{0}」には引き継ぐUVマップがありません。展開するか、別のソースを選んでください。",
        "“{0}”没有可传递的 UV 贴图。请展开，或选择另一个源。",
    ),
    (
        '"{0}" has nothing of what is to be carried over: no such attributes, materials, marked edges or custom '
        "normals. Choose other options, or another Source."
    ): (
        (
            "「{0}」には引き継ぐ属性、マテリアル、マークされた辺、カスタム法線がありません。別のオプションか、別のソー"
            "スを選んでください。"
        ),
        "“{0}”没有要传递的内容：没有此类属性、材质、标记边或自定义法线。请选择其他选项或另一个源。",
    ),
    (
        '"{0}" carries nothing of what is to be made symmetric: no vertex groups, shape keys or color attributes. '
        "Choose another object, or turn more of them on."
    ): (
        (
            "「{0}」には対称にするものがありません（頂点グループ、シェイプキー、カラー属性）。別のオブジェクトを選ぶか"
            "、対象を増やしてください。"
        ),
        "“{0}”没有可对称化的内容：没有顶点组、形态键或颜色属性。请选择其他物体，或启用更多选项。",
    ),
    "{0} left out: {1}": ("{0}は除外：{1}", "{0} 已跳过：{1}"),
    'the rig "{0}" with {1}': ("リグ「{0}」（{1}）", "绑定“{0}”（{1}）"),
    "1 bone": ("ボーン1本", "1 根骨骼"),
    "{0} bones": ("ボーン{0}本", "{0} 根骨骼"),
    "{0} vertex groups": ("{0}個の頂点グループ", "{0} 个顶点组"),
    "{0} UV maps": ("{0}個のUVマップ", "{0} 个 UV 贴图"),
    "1 vertex group": ("1個の頂点グループ", "1 个顶点组"),
    "{0} paired bones": ("ペアにした{0}本のボーン", "{0} 个已配对的骨骼"),
    "1 paired bone": ("ペアにした1本のボーン", "1 个已配对的骨骼"),
    "{0} actions": ("{0}個のアクション", "{0} 个动作"),
    "1 action": ("1個のアクション", "1 个动作"),
    "the pose": ("ポーズ", "姿态"),
    "1 UV map": ("1個のUVマップ", "1 个 UV 贴图"),
    '"{0}" has no attribute "{1}". Check the Names.': (
        "「{0}」に属性「{1}」はありません。名前を確認してください。",
        "“{0}”没有属性“{1}”。请检查名称。",
    ),
    'The shape keys of "{0}" are absolute. Turn Relative on in its Shape Keys panel, or remove them.': (
        "「{0}」のシェイプキーは絶対値です。シェイプキーパネルで相対をオンにするか、削除してください。",
        "“{0}”的形态键是绝对的。请在形态键面板中启用相对，或将其移除。",
    ),
    (
        '"{0}" is the basis of the shape keys of "{1}", but a shape key of the source has the same name. Rename one of '
        "them."
    ): (
        (
            "「{0}」は「{1}」のシェイプキーのベースですが、ソースに同じ名前のシェイプキーがあります。一方の名前を変えて"
            "ください。"
        ),
        "“{0}”是“{1}”的形态键的基型，但源有同名的形态键。请重命名其中一个。",
    ),
    'The shape key "{0}" of "{1}" is locked. Unlock it, or take the item out.': (
        "「{1}」のシェイプキー「{0}」はロックされています。ロックを解除するか、このアイテムを外してください。",
        "“{1}”的形态键“{0}”已锁定。请将其解锁，或去掉该物品。",
    ),
    'The shape keys of "{0}" do not have the vertices of its mesh. Remove them first.': (
        "「{0}」のシェイプキーの頂点がメッシュと一致しません。先に削除してください。",
        "“{0}”的形态键与其网格的顶点不一致。请先将其移除。",
    ),
    'The active shape key of "{0}" is its basis. Select another one in its Shape Keys panel.': (
        "「{0}」のアクティブなシェイプキーはベースです。シェイプキーパネルで別のものを選択してください。",
        "“{0}”的活动形态键是基型。请在形态键面板中另选一个。",
    ),
    '"{0}" has no shape key {1}. Check the Names.': (
        "「{0}」にシェイプキー{1}はありません。名前を確認してください。",
        "“{0}”没有形态键 {1}。请检查名称。",
    ),
    '"{0}" would have {1} UV maps, but Blender allows {2}. Remove some of them first, or carry fewer over.': (
        (
            "「{0}」のUVマップが{1}個になりますが、Blenderでは{2}個までです。先にいくつか削除するか、引き継ぐ数を減らし"
            "てください。"
        ),
        "“{0}”将有 {1} 个 UV 贴图，但 Blender 只允许 {2} 个。请先移除一些，或减少传递。",
    ),
    '"{0}" has no UV map "{1}". Check the Names.': (
        "「{0}」にUVマップ「{1}」はありません。名前を確認してください。",
        "“{0}”没有 UV 贴图“{1}”。请检查名称。",
    ),
    "{0} landmarks were left out: the two meshes were mirrored in different ways there, by their match": (
        "{0}個のランドマークを除外しました。マッチングによると、そこでは二つのメッシュの左右反転の仕方が異なります",
        "{0} 个地标被跳过：根据匹配，两个网格在那里的镜像方式不同",
    ),
    "Matching the coarse points exactly": ("粗いポイントを厳密にマッチング中", "正在精确匹配粗匹配点"),
    "Matching the surface to itself": ("表面を自身とマッチング中", "正在将表面与自身匹配"),
    "Comparing symmetries": ("対称性を比較中", "正在比较对称性"),
    "Simplifying": ("単純化中", "正在简化"),
    "Fitting the rig": ("リグを合わせています", "正在适配绑定"),
    "The {0} had {1} duplicate vertex along open seams: it was welded for matching.": (
        "{0}には開いた継ぎ目に沿って重複頂点が{1}個ありました。マッチングのために結合しました。",
        "{0}在开放的接缝处有 {1} 个重复顶点：已为匹配将其焊接。",
    ),
    "The {0} had {1} duplicate vertices along open seams: they were welded for matching.": (
        "{0}には開いた継ぎ目に沿って重複頂点が{1}個ありました。マッチングのために結合しました。",
        "{0}在开放的接缝处有 {1} 个重复顶点：已为匹配将其焊接。",
    ),
    "The {0} had {1} vertex at a gap between pieces: it was joined with the other border for matching.": (
        "{0}には部品の間の隙間に面した頂点が{1}個ありました。マッチングのために向かいの境界とつなぎました。",
        "{0}在各部分之间的缝隙处有 {1} 个顶点：已为匹配将其与对侧边界连接。",
    ),
    "The {0} had {1} vertices at gaps between pieces: they were joined with the other border for matching.": (
        "{0}には部品の間の隙間に面した頂点が{1}個ありました。マッチングのために向かいの境界とつなぎました。",
        "{0}在各部分之间的缝隙处有 {1} 个顶点：已为匹配将其与对侧边界连接。",
    ),
    "The {0} had {1} degenerate face: it was left out.": (
        "{0}には縮退した面が{1}個ありました。除外しました。",
        "{0}有 {1} 个退化面：已将其排除。",
    ),
    "The {0} had {1} degenerate faces: they were left out.": (
        "{0}には縮退した面が{1}個ありました。除外しました。",
        "{0}有 {1} 个退化面：已将其排除。",
    ),
    "The {0} had {1} repeated face: it was left out.": (
        "{0}には重複した面が{1}個ありました。除外しました。",
        "{0}有 {1} 个重复面：已将其排除。",
    ),
    "The {0} had {1} repeated faces: they were left out.": (
        "{0}には重複した面が{1}個ありました。除外しました。",
        "{0}有 {1} 个重复面：已将其排除。",
    ),
    "The {0} had {1} non-manifold edge: it was opened for matching.": (
        "{0}には非多様体の辺が{1}本ありました。マッチングのために切り開きました。",
        "{0}有 {1} 条非流形边：已为匹配将其切开。",
    ),
    "The {0} had {1} non-manifold edges: they were opened for matching.": (
        "{0}には非多様体の辺が{1}本ありました。マッチングのために切り開きました。",
        "{0}有 {1} 条非流形边：已为匹配将其切开。",
    ),
    "The {0} had {1} place where sheets touch in one vertex: it was separated for matching.": (
        "{0}には面どうしが一つの頂点で接している場所が{1}か所ありました。マッチングのために切り離しました。",
        "{0}有 {1} 处面片在一个顶点上相接：已为匹配将其分开。",
    ),
    "The {0} had {1} places where sheets touch in one vertex: they were separated for matching.": (
        "{0}には面どうしが一つの頂点で接している場所が{1}か所ありました。マッチングのために切り離しました。",
        "{0}有 {1} 处面片在一个顶点上相接：已为匹配将其分开。",
    ),
    "The {0} had {1} face of sheets that share an edge: it was left out.": (
        "{0}には一つの辺を共有する面の重なりに属する面が{1}個ありました。除外しました。",
        "{0}有 {1} 个面属于共用一条边的面片：已将其排除。",
    ),
    "The {0} had {1} faces of sheets that share an edge: they were left out.": (
        "{0}には一つの辺を共有する面の重なりに属する面が{1}個ありました。除外しました。",
        "{0}有 {1} 个面属于共用一条边的面片：已将其排除。",
    ),
    "The {0} had {1} face with normals against its neighbours: it was read the other way round.": (
        "{0}には法線が隣の面と逆向きの面が{1}個ありました。裏返して読み込みました。",
        "{0}有 {1} 个面的法线与相邻面相反：已按反方向读取。",
    ),
    "The {0} had {1} faces with normals against their neighbours: they were read the other way round.": (
        "{0}には法線が隣の面と逆向きの面が{1}個ありました。裏返して読み込みました。",
        "{0}有 {1} 个面的法线与相邻面相反：已按反方向读取。",
    ),
    "The {0} had {1} spike of one vertex: it was pulled in for matching.": (
        "{0}には頂点一つだけのとげが{1}個ありました。マッチングのために引き戻しました。",
        "{0}有 {1} 个单顶点的尖刺：已为匹配将其收回。",
    ),
    "The {0} had {1} spikes of one vertex: they were pulled in for matching.": (
        "{0}には頂点一つだけのとげが{1}個ありました。マッチングのために引き戻しました。",
        "{0}有 {1} 个单顶点的尖刺：已为匹配将其收回。",
    ),
    "The {0} had {1} small hole: it was closed for matching.": (
        "{0}には小さな穴が{1}個ありました。マッチングのためにふさぎました。",
        "{0}有 {1} 个小孔：已为匹配将其封闭。",
    ),
    "The {0} had {1} small holes: they were closed for matching.": (
        "{0}には小さな穴が{1}個ありました。マッチングのためにふさぎました。",
        "{0}有 {1} 个小孔：已为匹配将其封闭。",
    ),
    "The {0} had a surface with only one side: it was cut open for matching.": (
        "{0}には表裏の区別がない面がありました。マッチングのために切り開きました。",
        "{0}有一个单侧曲面：已为匹配将其切开。",
    ),
    "The normals of the {0} point inwards: they were read the other way round.": (
        "{0}の法線は内側を向いています。裏返して読み込みました。",
        "{0}的法线朝内：已按反方向读取。",
    ),
    "The {0} has {1} large opening: the surface ends there.": (
        "{0}には大きな開口部が{1}個あります。表面はそこで終わるものとします。",
        "{0}有 {1} 个大开口：表面到此为止。",
    ),
    "The {0} has {1} large openings: the surface ends there.": (
        "{0}には大きな開口部が{1}個あります。表面はそこで終わるものとします。",
        "{0}有 {1} 个大开口：表面到此为止。",
    ),
    "The {0} is made of {1} pieces: one surface around all of them was matched.": (
        "{0}は {1} 個のピースでできています: すべてを包む 1 つのサーフェスでマッチしました。",
        "{0}由 {1} 个部件组成：匹配的是包住所有部件的一个曲面。",
    ),
    "The {0} has {1} smaller part: it follows its surroundings.": (
        "{0}には小さなパーツが{1}個あります。周囲に従います。",
        "{0}有 {1} 个较小的部分：随周围移动。",
    ),
    "The {0} has {1} smaller parts: they follow their surroundings.": (
        "{0}には小さなパーツが{1}個あります。周囲に従います。",
        "{0}有 {1} 个较小的部分：随周围移动。",
    ),
    "The {0} has {1} loose vertex: it follows its surroundings.": (
        "{0}には孤立した頂点が{1}個あります。周囲に従います。",
        "{0}有 {1} 个孤立顶点：随周围移动。",
    ),
    "The {0} has {1} loose vertices: they follow their surroundings.": (
        "{0}には孤立した頂点が{1}個あります。周囲に従います。",
        "{0}有 {1} 个孤立顶点：随周围移动。",
    ),
    '"{0}" already has something else called "{1}", so that attribute was left out. Rename one of them.': (
        "「{0}」には「{1}」という別のものがすでにあるため、その属性は除外しました。一方の名前を変えてください。",
        "“{0}”已有另一个名为“{1}”的内容，因此该属性被排除。请重命名其中之一。",
    ),
    'The attribute "{0}" of "{1}" is of the type {2}, and was left out.': (
        "「{1}」の属性「{0}」は{2}型のため、除外しました。",
        "“{1}”的属性“{0}”属于 {2} 类型，已排除。",
    ),
    '{0} is moved by the armature "{1}" as well. Remove that Armature modifier unless both are meant to move it.': (
        (
            "{0}はアーマチュア「{1}」でも動きます。両方で動かすつもりでなければ、そのアーマチュアモディファイアーを削除"
            "してください。"
        ),
        "{0}也受骨架“{1}”驱动。除非有意由两者驱动，否则请移除那个骨架修改器。",
    ),
    '{0} keeps its parent "{1}".': ("{0}の親は「{1}」のままです。", "{0}保留其父级“{1}”。"),
    'The NLA tracks of the shape keys of "{0}" were left out.': (
        "「{0}」のシェイプキーのNLAトラックは除外しました。",
        "“{0}”的形态键的 NLA 轨道已排除。",
    ),
    'The shape keys of "{0}" keep their own action "{1}".': (
        "「{0}」のシェイプキーのアクションは「{1}」のままです。",
        "“{0}”的形态键保留自己的动作“{1}”。",
    ),
    "The imported match has no dense map: only its points were written, without colors and distortion.": (
        "読み込んだマッチングには密なマップがないため、ポイントだけを書き込みました。色と歪みはありません。",
        "导入的匹配没有稠密映射：只写入了它的点，没有颜色和畸变。",
    ),
    '{0} of "{1}" run where the target has no faces, and were left out.': (
        "「{1}」の{0}はターゲットに面のない場所を通るため、除外しました。",
        "“{1}”的{0}经过目标没有面的地方，已排除。",
    ),
    "1 landmark": ("1個のランドマーク", "1 个地标"),
    "{0} landmarks": ("{0}個のランドマーク", "{0} 个地标"),
    "1 line": ("1本の線", "1 条线"),
    "{0} lines": ("{0}本の線", "{0} 条线"),
    '"{0}" is moved by {1} as well as by "{2}". Only the latter was fitted.': (
        "「{0}」は「{2}」のほかに{1}でも動きます。「{2}」だけを合わせました。",
        "“{0}”除“{2}”外还受{1}驱动。只适配了“{2}”。",
    ),
    "The target seems to be in its rest pose already, so none was made. If it is posed, set Pose to Posed.": (
        (
            "ターゲットはすでにレストポーズのようなので、レストポーズは作成しませんでした。ポーズが付いている場合は、ポ"
            "ーズを「ポーズあり」にしてください。"
        ),
        "目标似乎已处于静置姿态，因此没有创建。如果它摆了姿势，请将姿态设为“已摆姿态”。",
    ),
    '"{0}", which was made before, lacks {1}.': (
        "以前に作成した「{0}」には{1}がありません。",
        "之前创建的“{0}”缺少{1}。",
    ),
    'Constraints or drivers move {0} of "{1}" away from rest, and the target with them. Check them.': (
        (
            "コンストレイントかドライバーが「{1}」の{0}を、ターゲットとともにレスト位置からずらしています。確認してくだ"
            "さい。"
        ),
        "约束或驱动器使“{1}”的{0}连同目标偏离静置位置。请检查。",
    ),
    'The shape keys of "{0}" are absolute; on "{1}", which has others, they are relative.': (
        "「{0}」のシェイプキーは絶対ですが、ほかのキーがある「{1}」では相対になります。",
        "“{0}”的形态键是绝对的；在已有其他形态键的“{1}”上则为相对的。",
    ),
    '"{0}" has no vertex group {1}, by which shape keys of "{2}" are limited. Carry the weights over first.': (
        "「{2}」のシェイプキーを制限する頂点グループ{1}が「{0}」にありません。先にウェイトを引き継いでください。",
        "“{0}”没有用来限制“{2}”的形态键的顶点组{1}。请先传递权重。",
    ),
    'Drivers of the shape keys of "{0}" still point to {1}.': (
        "「{0}」のシェイプキーのドライバーがまだ{1}を指しています。",
        "“{0}”的形态键的驱动器仍指向{1}。",
    ),
    (
        '"{0}" already has a vertex group or another attribute called "{1}", so that UV map was left out. Rename one '
        "of them."
    ): (
        (
            "「{0}」には「{1}」という頂点グループか別の属性がすでにあるため、そのUVマップは除外しました。一方の名前を変"
            "えてください。"
        ),
        "“{0}”已有名为“{1}”的顶点组或其他属性，因此该 UV 贴图被排除。请重命名其中之一。",
    ),
    '{0} of {1} islands of {2} lie where "{3}" has no faces, such as the inside of a mouth that only "{4}" has.': (
        "{2}のアイランド{1}個のうち{0}個は、「{4}」にしかない口の中のように、「{3}」に面のない場所にあります。",
        "{2}的 {1} 个孤岛中有 {0} 个位于“{3}”没有面的地方，例如只有“{4}”才有的口腔内部。",
    ),
    '{0} of {1} islands of {2} lie where the match has no confidence. Check them on "{3}".': (
        "{2}のアイランド{1}個のうち{0}個は、マッチングの信頼度がない場所にあります。「{3}」で確認してください。",
        "{2}的 {1} 个孤岛中有 {0} 个位于匹配没有置信度的地方。请在“{3}”上检查。",
    ),
    '{0} of "{1}" was left out: on "{2}" a match wrote what has that name.': (
        "「{1}」の{0}は除外しました。「{2}」ではマッチングが同じ名前のものを書き込んでいます。",
        "“{1}”的{0}已排除：“{2}”上同名的内容是由匹配写入的。",
    ),
    "1 vertex": ("1個の頂点", "1 个顶点"),
    "{0} vertices": ("{0}個の頂点", "{0} 个顶点"),
    "{0} of the vertices have no place on the other mesh and follow their surroundings.": (
        "頂点の{0}はもう一方のメッシュに対応する場所がなく、周囲に従います。",
        "{0} 的顶点在另一个网格上没有对应位置，随周围移动。",
    ),
    (
        'Custom normals of "{0}" bend with the key only roughly along seams. With the result New Object they fit the '
        "wrapped surface."
    ): (
        (
            "「{0}」のカスタム法線は、シームに沿ってはキーにおおよそしか従いません。結果を新規オブジェクトにすると、ラ"
            "ップした表面に合います。"
        ),
        "“{0}”的自定义法线沿缝合边只能大致跟随形态键。结果选“新物体”时，它们与包裹后的表面相符。",
    ),
    "The wrapped surface is folded in places, {0} of it.": (
        "ラップした表面はところどころ折れ重なっています（全体の{0}）。",
        "包裹后的表面有些地方发生折叠，占其 {0}。",
    ),
    "{0} and {1} more": ("{0}ほか{1}個", "{0} 等另外 {1} 个"),
    'Carried to "{0}": {1}': ("「{0}」に引き継ぎました：{1}", "已传递到“{0}”：{1}"),
    'Found for "{0}": {1}': ("「{0}」について見つけました：{1}", "已为“{0}”找到：{1}"),
    'the rig "{0}" with {1} and the rest pose "{2}"': (
        "リグ「{0}」（{1}）とレストポーズ「{2}」",
        "绑定“{0}”（{1}）和静置姿态“{2}”",
    ),
    "updated": ("更新済み", "已更新"),
    "a new object": ("新しいオブジェクト", "新物体"),
    'the shape key "{0}" on "{1}"': ("「{1}」のシェイプキー「{0}」", "“{1}”上的形态键“{0}”"),
    'the shape key "{0}" on {1} objects': ("{1}個のオブジェクトのシェイプキー「{0}」", "{1} 个物体上的形态键“{0}”"),
    "{0} new objects": ("{0}個の新しいオブジェクト", "{0} 个新物体"),
    'the action "{0}"': ("アクション「{0}」", "动作“{0}”"),
    "custom normals": ("カスタム法線", "自定义法线"),
    "1 attribute": ("1個の属性", "1 个属性"),
    "{0} attributes": ("{0}個の属性", "{0} 个属性"),
    "1 material": ("1個のマテリアル", "1 个材质"),
    "{0} materials": ("{0}個のマテリアル", "{0} 个材质"),
    "1 shape key": ("1個のシェイプキー", "1 个形态键"),
    "{0} shape keys": ("{0}個のシェイプキー", "{0} 个形态键"),
    "1 driver": ("1個のドライバー", "1 个驱动器"),
    "{0} drivers": ("{0}個のドライバー", "{0} 个驱动器"),
    "1 color attribute": ("1個のカラー属性", "1 个颜色属性"),
    "{0} color attributes": ("{0}個のカラー属性", "{0} 个颜色属性"),
    "Unlocked {0}": ("{0}のロックを解除しました", "已解锁 {0}"),
    "Removed {0}": ("{0}を削除しました", "已移除 {0}"),
    "Landmark {0} is {1}": ("ランドマーク{0}を{1}にしました", "地标 {0} 已{1}"),
    "on": ("オン", "启用"),
    "off": ("オフ", "停用"),
    "nothing": ("なし", "无"),
    'No bone of "{0}" that deforms has a vertex group on "{1}". Carry All groups, or turn Deform on for its bones.': (
        (
            "「{0}」の変形するボーンには「{1}」に頂点グループを持つものがありません。すべてのグループを引き継ぐか、ボー"
            "ンの変形をオンにしてください。"
        ),
        "“{0}”的形变骨骼在“{1}”上都没有顶点组。请传递所有组，或为其骨骼打开形变。",
    ),
    (
        'No bone of "{0}" that is selected has a vertex group on "{1}". Carry All groups, or select others of its '
        "bones in Pose Mode."
    ): (
        (
            "「{0}」の選択中のボーンには「{1}」に頂点グループを持つものがありません。すべてのグループを引き継ぐか、ポー"
            "ズモードでほかのボーンを選択してください。"
        ),
        "“{0}”的选中骨骼在“{1}”上都没有顶点组。请传递所有组，或在姿态模式下选择其他骨骼。",
    ),
    "1 note": ("注記1件", "1 条说明"),
    "{0} notes": ("注記{0}件", "{0} 条说明"),
    "Fit My Rig": ("マイリグをフィット", "适配我的骨架"),
    "My Rig": ("マイリグ", "我的骨架"),
    (
        "Give the matched meshes a copy each of an armature that stands in the source, such as a metarig of Rigify or "
        "a standard skeleton, with its joints where they belong in them. It need not move the source"
    ): (
        (
            "ソースの中に立つアーマチュア、たとえばRigifyのメタリグや標準スケルトンのコピーを、対応づけたメッシュそれぞ"
            "れに、関節を正しい位置に置いて与えます。ソースを動かしていなくても構いません"
        ),
        (
            "为每个已匹配的网格提供一份站在源中的骨架（例如Rigify的元骨架或标准骨架）的副本，并把关节放到正确的位置。它"
            "不必驱动源"
        ),
    ),
    (
        "Name of an armature that stands in the source without moving it, such as a metarig of Rigify. It may be bound "
        "to nothing"
    ): (
        (
            "ソースの中に立ち、ソースを動かしていないアーマチュアの名前。Rigifyのメタリグなど。何にもバインドされていな"
            "くて構いません"
        ),
        "站在源中但不驱动源的骨架的名称，例如Rigify的元骨架。它可以没有绑定任何物体",
    ),
    "Bind with Weights": ("ウェイトでバインド", "带权重绑定"),
    (
        "Bind the target to the fitted rig, with the weights of the source's own rig, handed to the bones that move "
        "the same surface. Leave it off for a metarig"
    ): (
        (
            "ソース自身のリグのウェイトを、同じ表面を動かすボーンに渡して、ターゲットをフィットしたリグにバインドします"
            "。メタリグではオフのままにしてください"
        ),
        "把源自身骨架的权重交给驱动相同表面的骨骼，并将目标绑定到适配后的骨架。对元骨架请保持关闭",
    ),
    (
        '"{0}" moves no mesh, so nothing tells where in a body its joints belong. Choose as the Source a mesh in which '
        "it stands, and name the armature as the Rig."
    ): (
        (
            "「{0}」はどのメッシュも動かしていないため、関節が体のどこにあるべきか分かりません。それが中に立つメッシュ"
            "をソースに選び、アーマチュアをリグとして指定してください。"
        ),
        "“{0}”没有驱动任何网格，因此无法得知其关节应在身体的哪里。请选择它所站立的网格作为源，并将该骨架指定为骨架。",
    ),
    '"{0}" moves "{1}". To give a target the rig that moves the source, use Retarget with Rig on.': (
        (
            "「{0}」は「{1}」を動かしています。ソースを動かすリグをターゲットに与えるには、「リグ」をオンにして「リター"
            "ゲット」を使ってください。"
        ),
        "“{0}”带动“{1}”。要把带动源的绑定给予目标，请打开“绑定”并使用“重定向”。",
    ),
    "Which armature is to be fitted is open. Name one as the Rig.": (
        "フィットするアーマチュアが分かりません。リグとして一つ指定してください。",
        "不清楚要适配哪个骨架。请将一个骨架指定为骨架。",
    ),
    '"{0}" is not an armature. Name one as the Rig.': (
        "「{0}」はアーマチュアではありません。リグとしてアーマチュアを指定してください。",
        "“{0}”不是骨架。请将一个骨架指定为骨架。",
    ),
    (
        '"{0}" does not stand in "{1}": most of its bones lie outside, also if it is moved there and scaled. Move its '
        "joints into that body in Edit Mode first."
    ): (
        (
            "「{0}」は「{1}」の中に立っていません。そこへ移動して拡大縮小しても、ほとんどのボーンが外にあります。先に編"
            "集モードで関節をその体の中に移してください。"
        ),
        "“{0}”没有站在“{1}”中：即使移动到那里并缩放，其大部分骨骼仍在外面。请先在编辑模式下把关节移入该身体。",
    ),
    (
        '"{0}" has no weights that could be handed to the bones of "{1}". Switch Bind with Weights off, and bind the '
        "target by Blender's automatic weights afterwards."
    ): (
        (
            "「{0}」には「{1}」のボーンに渡せるウェイトがありません。「ウェイト付きでバインド」をオフにして、後で "
            "Blenderの自動ウェイトでターゲットをバインドしてください。"
        ),
        "“{0}”没有可以交给“{1}”的骨骼的权重。请关闭“带权重绑定”，之后用Blender的自动权重绑定目标。",
    ),
    "Carrying joints": ("関節を移しています", "正在转移关节"),
    '"{0}" moves nothing yet. Generate its control rig, or bind "{1}" to it.': (
        "「{0}」はまだ何も動かしていません。コントロールリグを生成するか、「{1}」をそれにバインドしてください。",
        "“{0}”还没有驱动任何东西。请生成其控制骨架，或将“{1}”绑定到它。",
    ),
    '"{0}" did not stand in "{1}", so it was moved there and scaled.': (
        "「{0}」は「{1}」の中に立っていなかったため、そこへ移動して拡大縮小しました。",
        "“{0}”没有站在“{1}”中，因此已移动到那里并缩放。",
    ),
    "Rename Bones": ("ボーンの名前を変更", "重命名骨骼"),
    (
        "Give the bones of the target's rig the names of a standard, or of the source's bones. Vertex groups, actions, "
        "constraints and drivers follow"
    ): (
        (
            "ターゲットのリグのボーンに、規格の名前か、ソースのボーンの名前を付けます。頂点グループ、アクション、コンス"
            "トレイント、ドライバーも追従します"
        ),
        "为目标骨架的骨骼赋予某种标准的名称，或源骨骼的名称。顶点组、动作、约束和驱动器会随之更新",
    ),
    "Name of an armature, or of what it moves; if empty, the one picked in the panel or else the active object": (
        "アーマチュア、またはそれが動かすものの名前。空の場合はパネルで選んだもの、なければアクティブオブジェクト",
        "骨架或其驱动物体的名称；若为空，则为面板中所选，否则为活动物体",
    ),
    "Name of the armature whose names are taken over, or of what it moves; if empty, the one picked in the panel": (
        "名前を引き継ぐアーマチュア、またはそれが動かすものの名前。空の場合はパネルで選んだもの",
        "要沿用其名称的骨架，或其驱动物体的名称；若为空，则为面板中所选",
    ),
    "What the bones are to be called": ("ボーンに付ける名前", "骨骼要用的名称"),
    "Names of the humanoid bones of VRM 1.0, such as leftUpperArm": (
        "VRM 1.0のヒューマノイドボーンの名前。leftUpperArmなど",
        "VRM 1.0人形骨骼的名称，例如leftUpperArm",
    ),
    "Names of Mixamo, such as mixamorig:LeftArm": (
        "Mixamoの名前。mixamorig:LeftArmなど",
        "Mixamo的名称，例如mixamorig:LeftArm",
    ),
    "Names of Unreal's mannequin, such as upperarm_l": (
        "Unrealのマネキンの名前。upperarm_lなど",
        "Unreal人体模型的名称，例如upperarm_l",
    ),
    "Names of the bones of Rigify that deform, such as DEF-upper_arm.L": (
        "Rigifyの変形ボーンの名前。DEF-upper_arm.Lなど",
        "Rigify变形骨骼的名称，例如DEF-upper_arm.L",
    ),
    "The names of the source's bones with which they are paired, whatever they move": (
        "ペアになっているソースのボーンの名前",
        "与之配对的源骨骼的名称",
    ),
    "Known by": ("判断の手がかり", "依据"),
    "What tells which bone is which, for a standard": (
        "規格の名前を付けるとき、どのボーンが何かを何で判断するか",
        "使用标准名称时，依据什么判断每根骨骼是什么",
    ),
    "Joints": ("関節", "关节"),
    "Where the joints are, and what hangs on what. Names do not matter": (
        "関節の位置と親子関係。名前は関係ありません",
        "关节的位置和父子关系。名称无关紧要",
    ),
    '{0} of "{1}" got another name': ("「{1}」の{0}の名前を変更しました", "“{1}”的{0}已改名"),
    "{0} kept the name: there is none for it": (
        "{0}は該当する名前がないため元の名前のままです",
        "{0}保留原名：没有对应的名称",
    ),
    (
        'The bones of "{0}" are linked from another file and cannot be renamed here. Make it local first (Object > '
        "Relations > Make Local)."
    ): (
        (
            "「{0}」のボーンは別のファイルからリンクされているため、ここでは名前を変更できません。先にローカル化してく"
            "ださい（オブジェクト > 関係 > ローカル化）。"
        ),
        "“{0}”的骨骼链接自其他文件，无法在此重命名。请先将其本地化（物体 > 关系 > 本地化）。",
    ),
    'No bone of "{0}" has a name of that standard. Choose another one.': (
        "「{0}」にはその規格の名前のボーンがありません。別のものを選んでください。",
        "“{0}”没有该标准名称的骨骼。请选择其他标准。",
    ),
    '"{0}" has other bones that are called {1} already. Rename them first.': (
        "「{0}」にはすでに{1}という別のボーンがあります。先にその名前を変更してください。",
        "“{0}”已有其他名为{1}的骨骼。请先重命名它们。",
    ),
    '"{0}" has other vertex groups that are called {1} already. Rename them first.': (
        "「{0}」にはすでに{1}という別の頂点グループがあります。先にその名前を変更してください。",
        "“{0}”已有其他名为{1}的顶点组。请先重命名它们。",
    ),
    (
        '"{0}" plays {1} as well, and would no longer be moved by it. Give "{2}" a copy first: press the number beside '
        "its name in the Action Editor."
    ): (
        (
            '"{0}"も{1}を再生しており、それでは動かなくなります。先に"{2}"へコピーを割り当ててください。アクションエデ'
            "ィターで名前の横の数字を押します。"
        ),
        '"{0}" 也在播放 {1}，此后将不再被其带动。请先给 "{2}" 一份副本：在动作编辑器中按其名称旁的数字。',
    ),
    "Posing controls": ("コントロールのポーズを求めています", "正在摆放控制器"),
    "Looking for controls": ("コントロールを探しています", "正在寻找控制器"),
    '{0} of "{1}" was set so that its bones follow the controls with keys.': (
        "「{1}」のボーンがキーのあるコントロールに従うように、{0}を設定しました。",
        "已设置“{1}”的{0}，使其骨骼跟随带关键帧的控制器。",
    ),
    'No control turns {0} of "{1}".': ("「{1}」の{0}を回すコントロールがありません。", "没有控制器能转动“{1}”的{0}。"),
    '{0} of "{1}" could not be turned as they should be by their controls.': (
        "「{1}」の{0}は、コントロールでは正しい向きにできませんでした。",
        "“{1}”的{0}无法通过其控制器转到应有的方向。",
    ),
}
"""For each English text its translations."""
