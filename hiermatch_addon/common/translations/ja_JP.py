# SPDX-License-Identifier: GPL-3.0-or-later
# ruff: noqa: N999 - this is how Blender calls the language
"""Texts of the interface in Japanese: the English as it stands in the code, and its translation."""

from __future__ import annotations

from typing import Final

MESSAGES: Final[dict[str, str]] = {
    "Points": "ポイント",
    "How many points were matched": "マッチングしたポイントの数",
    "Source": "ソース",
    "Name of the source object": "ソースオブジェクトの名前",
    "Target": "ターゲット",
    "Name of the target object; of several, of the last one": (
        "ターゲットオブジェクトの名前。複数ある場合は最後のもの"
    ),
    "Name of the target object": "ターゲットオブジェクトの名前",
    "Distortion": "歪み",
    "Distortion of the whole match": "マッチング全体の歪み",
    "Stretch": "伸び",
    "By how much lengths differ between the two meshes on average, by the dense map": (
        "密なマップによる、二つのメッシュの間での長さの平均的な違い"
    ),
    "Worst Point": "最悪のポイント",
    "Largest distortion of a matched point, in units of the square root of the surface area": (
        "対応点の最大の歪み。表面積の平方根を単位とします"
    ),
    "Optimum Proven": "最適性の証明",
    "Whether no coarse match has less distortion": "これより歪みの小さい粗いマッチングが存在しないかどうか",
    "Gap": "ギャップ",
    "By how much, at most, the coarse match can be worse than the best one": (
        "粗いマッチングが最良のものより最大でどれだけ劣りうるか"
    ),
    "Orientation": "向き",
    "From 1, left stays left, to -1, the match mirrors the shape": (
        "1では左が左のまま、-1ではマッチングが形状を左右反転します"
    ),
    "Answers": "解",
    "Names of all answers: the direct one and its alternatives, one per line": (
        "すべての解の名前。直接の解とその代替解を1行に1つずつ"
    ),
    "Chosen Answer": "選ばれた解",
    "Number of the answer that is written on the meshes, from 0 for the direct one": (
        "メッシュに書き込まれている解の番号。直接の解が0"
    ),
    "Verdict": "判定",
    "How far the dense map can be trusted, in a sentence; empty if there is none": (
        "密なマップをどこまで信頼できるかを一文で示します。マップがなければ空です"
    ),
    "Overlap": "重なり",
    "Confidence": "信頼度",
    "How far the dense map can be trusted as a whole": "密なマップ全体をどこまで信頼できるか",
    "Out of Date": "期限切れ",
    "Why the match is out of date; empty as long as it is not known to be": (
        "マッチングが古くなった理由。古いと判明していない間は空です"
    ),
    "Swapped": "入れ替え済み",
    "Whether source and target were exchanged since they were matched": (
        "マッチング後にソースとターゲットが入れ替えられたかどうか"
    ),
    "Lost": "消失",
    "Whether one of its meshes was deleted, or carries the match no more": (
        "そのメッシュの一方が削除されたか、マッチングをもう持っていないかどうか"
    ),
    "Of Others": "別のペア",
    "Whether the match is of other meshes than those that are picked": (
        "選ばれているものとは別のメッシュのマッチングかどうか"
    ),
    "Seconds": "秒",
    "How long the match took; zero if that is not known": "マッチングにかかった時間。不明な場合は0です",
    "Notes": "注記",
    "What should be known about the match, one sentence per line": (
        "マッチングについて知っておくべきこと。一行に一文です"
    ),
    "Prefix": "接頭辞",
    "What the names of everything that was written start with": "書き込まれたすべてのものの名前の先頭に付く文字列",
    "Key": "キー",
    "By what the two meshes are recognised as the pair of this match": (
        "二つのメッシュがこのマッチングのペアだと識別するためのもの"
    ),
    (
        "Mesh that is matched, or an armature or an empty with all meshes that hang on it; if nothing is picked, what "
        "is active"
    ): (
        "マッチするメッシュ、またはアーマチュアかエンプティとそれに付くすべてのメッシュ。何も指定されていなければア"
        "クティブなもの"
    ),
    (
        "Mesh that corresponding points are sought on, or an armature or an empty with all meshes that hang on it; if "
        "nothing is picked, what else is selected"
    ): (
        "対応するポイントを探すメッシュ、またはアーマチュアかエンプティとそれに付くすべてのメッシュ。何も指定されて"
        "いなければ選択中のほかのもの"
    ),
    "Source Collection": "ソースコレクション",
    "Target Collection": "ターゲットコレクション",
    "Collection whose meshes are the source together, if no object is picked": (
        "オブジェクトが選ばれていないとき、まとめてソースとなるメッシュのコレクション"
    ),
    "Collection whose meshes are the target together, if no object is picked": (
        "オブジェクトが選ばれていないとき、まとめてターゲットとなるメッシュのコレクション"
    ),
    "Summary": "概要",
    "The last match": "最後のマッチング",
    "How many points of the source are matched at the finest level": (
        "最も細かいレベルでマッチングするソースのポイントの数"
    ),
    "Coarse Points": "粗いポイント",
    "How many points are matched exactly, by branch and bound, before all others": (
        "ほかのすべてより先に、分枝限定法で厳密にマッチングするポイントの数"
    ),
    "Coarse Candidates": "粗い候補",
    "How many points of the target the coarse points may be matched to": (
        "粗いポイントの相手になりうるターゲットのポイントの数"
    ),
    "Solver": "ソルバー",
    "How the points are matched": "ポイントをマッチングする方法",
    "Hierarchical": "階層的",
    "Some points exactly, then more and more, level by level": (
        "まず一部のポイントを厳密に、それからレベルごとに数を増やします"
    ),
    "Flat": "フラット",
    "All points at once, exactly: for comparison, and for some 30 points at most": (
        "すべてのポイントを一度に厳密にマッチングします。比較用で、ポイントは30程度までです"
    ),
    "Generalized Multidimensional Scaling": "一般化多次元尺度構成法",
    "From the coarse match, points move over the target by their distances alone: for comparison": (
        "粗いマッチングから始め、距離だけに従ってポイントをターゲット上で動かします。比較用です"
    ),
    "Dense Map": "密なマップ",
    (
        "Find the corresponding point for every vertex of both meshes. The matched points then lie where this map "
        "takes them"
    ): "両方のメッシュのすべての頂点について対応点を求めます。対応点はこのマップが示す位置に置かれます",
    "Settle": "落ち着かせる",
    (
        "At last let the points leave the samples of the target and come to rest between its vertices "
        "(hierarchical solver without a dense map)"
    ): "最後にポイントをターゲットのサンプルから離し、頂点の間に落ち着かせます(階層的ソルバーで密なマップがない場合)",
    "Metric": "距離",
    "What distances between points of a surface are kept": "表面上のポイント間のどの距離を保つか",
    "Geodesic": "ジオデシック",
    "Length of the shortest path on the surface, by fast marching": "高速マーチング法による、表面上の最短経路の長さ",
    "Diffusion": "拡散",
    "How differently heat spreads from two points: less affected by holes and touching parts": (
        "二点からの熱の広がり方の違い。穴や接触した部分の影響を受けにくくなります"
    ),
    "Diffusion Time": "拡散時間",
    "How long heat spreads for diffusion distances, in units of the surface area; 0 chooses by the shape": (
        "拡散距離のために熱を広げる時間。表面積を単位とし、0では形状に応じて選びます"
    ),
    "Descriptor": "記述子",
    "By what a point is recognised, beside its distances to the other points": (
        "ほかのポイントとの距離のほかに、何によってポイントを見分けるか"
    ),
    "Distance Histograms": "距離ヒストグラム",
    "How many places lie how far away, in the chosen metric": "選んだ距離で、どれだけの場所がどれだけ離れているか",
    "Heat Kernel Signatures": "熱核シグネチャ",
    "How much heat stays at the point, over time": "時間とともにそのポイントに残る熱の量",
    "Wave Kernel Signatures": "波動核シグネチャ",
    "How strongly the point vibrates, over frequency": "周波数ごとにそのポイントがどれだけ強く振動するか",
    "Laplace-Beltrami Eigenfunctions": "ラプラス・ベルトラミ固有関数",
    "Values of the lowest vibrations of the surface, with every consistent choice of their signs": (
        "表面の最も低い振動の値。矛盾のない符号の選び方をすべて考慮します"
    ),
    "Comparison": "比較",
    "How histograms are compared": "ヒストグラムの比較方法",
    "Earth Mover's": "アースムーバー距離",
    "How far the mass of one has to be moved to make the other": "一方の質量をどれだけ動かせばもう一方になるか",
    "Bin to Bin": "ビンごと",
    "The difference in each bin by itself": "各ビンそれぞれの差",
    "Constraint": "コンストレイント",
    "How points and candidates of the coarse step are to correspond": "粗い段階のポイントと候補の対応のさせ方",
    "Injective": "単射",
    "Each point gets a candidate of its own; candidates may stay unused": (
        "各ポイントがそれぞれ別の候補を持ちます。使われない候補があってもかまいません"
    ),
    "Bijective": "全単射",
    "As many candidates as points, and each is used": "候補の数はポイントと同じで、すべて使われます",
    "Descriptor Weight": "記述子のウェイト",
    "How much the differences of descriptors count": "記述子の差をどれだけ重視するか",
    "Distance Weight": "距離のウェイト",
    "How much the differences of distances between points count": "ポイント間の距離の差をどれだけ重視するか",
    "Neighbourhood": "近傍",
    "Among how many of the target samples around its present match each point looks for a better one": (
        "各ポイントがよりよい相手を探す、現在の相手の周りにあるターゲットのサンプルの数"
    ),
    "Samples": "サンプル数",
    (
        "How many samples of each surface describe it; the points are matched to the samples of the target. With a "
        "dense map three quarters as many are taken, and at least twice as many as points"
    ): (
        "各表面を表すサンプルの数。ポイントはターゲットのサンプルにマッチングされます。密なマップがあると、その"
        "四分の三、ただし少なくともポイントの二倍を取ります"
    ),
    "Hypotheses": "仮説",
    (
        "How many distinct coarse matchings are followed up before the best is chosen. Nearly symmetric shapes "
        "have several that are almost equally good. With a dense map half as many are taken"
    ): (
        "最良のものを選ぶまでに追跡する、異なる粗いマッチングの数。ほぼ対称な形状には、ほとんど同じくらいよいも"
        "のが複数あります。密なマップがあると、その半分を取ります"
    ),
    "Histogram Bins": "ヒストグラムのビン",
    "Number of bins of the distance histograms that describe a point": "ポイントを記述する距離ヒストグラムのビンの数",
    "Eigenfunctions": "固有関数",
    "How many of the lowest eigenfunctions describe a point": "ポイントの記述に使う最も低い固有関数の数",
    "Eigenpairs": "固有対",
    "How many eigenpairs of the Laplace-Beltrami operator make up diffusion distances and kernel signatures": (
        "拡散距離と核シグネチャを構成する、ラプラス・ベルトラミ作用素の固有対の数"
    ),
    "Search Limit": "探索の上限",
    "After how many nodes the exact search stops with the best matching so far and a bound on the optimum": (
        "厳密な探索がこの数のノードの後に停止し、それまでの最良のマッチングと最適値の限界を返します"
    ),
    "Use Modifiers": "モディファイアー込み",
    (
        "Match the meshes as their shape keys and modifiers show them. Possible unless a modifier adds or removes "
        "vertices"
    ): (
        "シェイプキーとモディファイアーが示す形でメッシュをマッチングします。頂点を増減するモディファイアーがな"
        "ければ可能です"
    ),
    "Alternative": "代替解",
    (
        "For a shape that looks the same from several sides, which of the other answers to write, if there are as "
        "many: 1 is the one in which left and right are exchanged, if there is one. 0 writes the direct answer"
    ): (
        "いくつかの側から同じに見える形状について、他のどの解を書き込むか(それだけの数がある場合)。1は左右を入れ替えた"
        "解です(ある場合)。0では直接の解を書き込みます"
    ),
    "Use Landmarks": "ランドマークを使用",
    "Keep to the landmarks that the two meshes have in common and that are switched on": (
        "二つのメッシュに共通し、オンになっているランドマークを守ります"
    ),
    "Leave Out of Source": "ソースから除外",
    (
        "Vertex group, boolean attribute, material or face set of the source whose vertices are not matched. In the "
        "dense map they follow what is around them"
    ): (
        "頂点をマッチングしない、ソースの頂点グループ、ブール属性、マテリアル、またはフェイスセット。"
        "密なマップでは周囲に従います"
    ),
    "Leave Out of Target": "ターゲットから除外",
    (
        "Vertex group, boolean attribute, material or face set of the target whose vertices are not matched. In the "
        "dense map they follow what is around them"
    ): (
        "頂点をマッチングしない、ターゲットの頂点グループ、ブール属性、マテリアル、またはフェイスセット。"
        "密なマップでは周囲に従います"
    ),
    "What the names of everything that is written start with. Another prefix keeps the results of other matches": (
        "書き込むすべてのものの名前の先頭に付く文字列。接頭辞を変えると、ほかのマッチングの結果が残ります"
    ),
    "Vertex Groups": "頂点グループ",
    "Write a vertex group for each matched point; groups of the same name are the same point": (
        "対応点ごとに頂点グループを書き込みます。同じ名前のグループが同じポイントです"
    ),
    "Match Colors": "マッチングカラー",
    "Write a color attribute that gives corresponding places of both meshes the same color": (
        "両方のメッシュの対応する場所に同じ色を与えるカラー属性を書き込みます"
    ),
    (
        "Write how much lengths differ around each place, as a color attribute from dark blue (none) to yellow "
        "(twice or half as long), and as an attribute of numbers. Without a dense map: how much the distances to "
        "the matched points differ, yellow being the most"
    ): (
        "各場所の周りで長さがどれだけ異なるかを、暗い青(差なし)から黄(二倍または半分)までのカラー属性と数値の属"
        "性として書き込みます。密なマップがなければ、対応点までの距離の差を示し、黄が最大です"
    ),
    (
        "Write how far the dense map can be trusted at each place, as a color attribute from dark red (not at all) "
        "to white (fully)"
    ): "各場所で密なマップをどこまで信頼できるかを、暗い赤(まったく)から白(完全に)までのカラー属性として書き込みます",
    "Fraction": "割合",
    "Part of the match that is done": "マッチングの完了した割合",
    "Label": "ラベル",
    "What is being done": "実行中の作業",
    "Cancel": "キャンセル",
    "Whether the running match is to end": "実行中のマッチングを終了するかどうか",
    "Question": "質問",
    "What has to be answered before the work goes on, one sentence per line": (
        "作業を続ける前に答える必要があること。一行に一文"
    ),
    "Answer": "回答",
    "The answer; empty as long as there is none": "回答。まだないうちは空",
    "Say what is to become of a match that is not to be trusted": "信頼できないマッチングをどうするかを決めます",
    "What is to be done": "どうするか",
    "Match Again with Landmarks": "ランドマークでやり直す",
    "Write nothing, name corresponding places by clicks, and match again": (
        "何も書き込まず、対応する場所をクリックで示してから、もう一度マッチングします"
    ),
    "Write Anyway": "そのまま書き込む",
    "Carry everything across the match as it is; one Undo takes it back": (
        "今のマッチングのまま引き継ぎます。一回の「元に戻す」で取り消せます"
    ),
    "Write nothing": "何も書き込みません",
    "Waiting for an answer": "回答を待っています",
    "Nothing is asked": "何も質問されていません",
    "Nothing was written. Name corresponding places by clicks, and match again": (
        "何も書き込まれていません。対応する場所をクリックで示して、もう一度マッチングしてください"
    ),
    "The match is doubtful": "このマッチングは疑わしいものです",
    'The match with "{0}" is doubtful. {1}': "「{0}」とのマッチングは疑わしいものです。{1}",
    (
        'The match of "{0}" and "{1}" is doubtful, and nothing was written. {2} Add landmarks and match '
        "again, or set Accept Doubtful to write it all the same."
    ): (
        "「{0}」と「{1}」のマッチングは疑わしいため、何も書き込まれていません。{2}ランドマークを加えてもう一"
        "度マッチングするか、それでも書き込むには「疑わしくても書き込む」を設定してください。"
    ),
    "Confidence {0}: {1}": "信頼度{0}：{1}",
    "Confidence {0}: {1} Note: {2}": "信頼度{0}：{1}注意：{2}",
    (
        '"{0}" is open at {1} ends and looks like a garment for "{2}": if it is one, fit it with Wear '
        "instead; if not, and the match is wrong, leave out of the other mesh what it lacks."
    ): (
        "「{0}」は{1}か所の端が開いており、「{2}」の衣服のように見えます。衣服なら、代わりに「着せる」で合"
        "わせてください。そうでなく、マッチングが正しくない場合は、これにない部分をもう一方のメッシュから除外してくださ"
        "い。"
    ),
    '"{0}" has a Mirror modifier, and was matched as the half that it is: if the match is wrong, apply the modifier, '
    "and match again.": (
        "「{0}」にはミラーモディファイアーがあり、半分のままマッチングされました。マッチングが正しくない場合は、モディファイアーを"
        "適用して、もう一度マッチングしてください。"
    ),
    'What hangs on single bones of "{0}": {1}. Hide what "{2}" has not, such as weapons, and match again.': (
        "「{0}」で一つのボーンに付いているもの：{1}。武器など「{2}」にないものを隠して、もう一度マッチングしてください。"
    ),
    '"{0}" looks like a part of "{1}": if the match is wrong, name what it lacks under Leave Out, and match again.': (
        "「{0}」は「{1}」の一部のように見えます。マッチングが正しくない場合は、これにない部分を「除外」で指定して、もう一度マッチングしてください。"
    ),
    "Match": "マッチング",
    (
        "Find corresponding points of two meshes, whatever their pose, and write them on both as vertex groups and "
        "colors"
    ): "ポーズを問わず二つのメッシュの対応点を求め、両方に頂点グループと色として書き込みます",
    "End the running match or transfer without writing anything": (
        "何も書き込まずに、実行中のマッチングや転送を終了します"
    ),
    "Use Setup": "設定例を使用",
    "Set metric and descriptor as in one of the setups that the paper compares": (
        "論文が比較する設定例の一つと同じ距離と記述子を設定します"
    ),
    "Setup": "設定例",
    "Which of the paper's setups to use": "論文のどの設定例を使うか",
    "Geodesic Histograms": "ジオデシックヒストグラム",
    "Default": "デフォルト",
    "Set Metric to Geodesic, Descriptor to Distance Histograms, as in figure 2 (a) of the paper": (
        "論文の図2(a)のように、「距離」を「ジオデシック」、「記述子」を「距離ヒストグラム」にします"
    ),
    "Diffusion Histograms": "拡散ヒストグラム",
    "Set Metric to Diffusion, Descriptor to Distance Histograms, as in figure 2 (b) of the paper": (
        "論文の図2(b)のように、「距離」を「拡散」、「記述子」を「距離ヒストグラム」にします"
    ),
    "Set Metric to Diffusion, Descriptor to Heat Kernel Signatures, as in figure 2 (c) of the paper": (
        "論文の図2(c)のように、「距離」を「拡散」、「記述子」を「熱核シグネチャ」にします"
    ),
    "Set Metric to Geodesic, Descriptor to Laplace-Beltrami Eigenfunctions, as in figure 2 (d) of the paper": (
        "論文の図2(d)のように、「距離」を「ジオデシック」、「記述子」を「ラプラス・ベルトラミ固有関数」にします"
    ),
    (
        "Number of the answer: 0 is the direct one, and -1 the one after that which is written; of two answers, the "
        "other one"
    ): "解の番号。0は直接の解、-1は書き込まれている解の次の解です。解が二つなら、もう一方の解です",
    "Other Answers": "他の解",
    "Use Another Answer": "別の解を使用",
    "Use Mirrored Match": "ミラーマッチングを使用",
    (
        "Write another answer of the match, such as the one in which left and right are exchanged, without matching "
        "again. The first answer can be brought back"
    ): ("マッチングの別の解(左右を入れ替えたものなど)を、再マッチングせずに書き込みます。最初の解に戻すこともできます"),
    "Object": "オブジェクト",
    (
        "Name of one of the two matched objects; if empty, the match of what is picked in the panel is "
        "meant, or else that of the active object"
    ): (
        "マッチングした二つのオブジェクトの一方の名前。空ならパネルで選ばれているもののマッチング、なけれ"
        "ばアクティブオブジェクトのマッチング"
    ),
    (
        "What the names that the match wrote start with; needed only for a named or active object that carries "
        "several matches"
    ): (
        "マッチングが書き込んだ名前の先頭。名前で指定した、またはアクティブなオブジェクトが複数のマッチングを持"
        "つ場合にだけ必要です"
    ),
    "Swap Source and Target": "ソースとターゲットを入れ替え",
    "Exchange Source and Target; the match that the two carry, with its dense map, then serves the other way round": (
        "ソースとターゲットを入れ替えます。両者が持つマッチングは、密なマップも含めて逆向きに使われます"
    ),
    "Clear": "クリア",
    (
        "Remove what matches have written on Source, Target and the selected meshes; landmarks and what was carried "
        "over stay"
    ): (
        "マッチングがソース、ターゲット、選択中のメッシュに書き込んだものを削除します。ランドマークと転送されたもの"
        "は残ります"
    ),
    "Name of the object to clear; if empty, the picked Source and Target and all selected meshes": (
        "クリアするオブジェクトの名前。空なら選んだソースとターゲット、および選択中のすべてのメッシュ"
    ),
    "Remove only what was written with this prefix; if empty, everything": (
        "この接頭辞で書き込まれたものだけを削除します。空ならすべて"
    ),
    "Export Match": "対応を書き出し",
    (
        "Write the match that two meshes carry into a file, with its dense maps, for other programs or to import "
        "it again"
    ): (
        "二つのメッシュが持つマッチングを密なマップとともにファイルに書き出し、ほかのプログラムや再インポートで"
        "使えるようにします"
    ),
    "Filter": "フィルター",
    "Which files the browser lists": "ファイルブラウザーに表示するファイル",
    (
        "Name of one of the two objects; if empty, the one picked in the panel, or the active object, or one of "
        "the match that the panel shows"
    ): (
        "二つのオブジェクトの一方の名前。空ならパネルで選んだもの、アクティブオブジェクトか、"
        "パネルに表示中のマッチングの一方"
    ),
    (
        "Name of the other object; if empty, the one picked in the panel, or the other selected mesh, or the other "
        "one of the match that the panel shows"
    ): (
        "もう一方のオブジェクトの名前。空ならパネルで選んだもの、選択中のもう一つのメッシュか、パネルに表示中のマッチングのもう一方"
    ),
    "What the names start with that the match wrote; if empty, the one match that the objects carry": (
        "マッチングが書き込んだ名前の先頭。空なら両オブジェクトが持つ唯一のマッチング"
    ),
    "Import Match": "対応を読み込み",
    (
        "Write a match that was exported to a file on two meshes with the same vertices and faces, in whatever "
        "pose, as if they had just been matched"
    ): (
        "ファイルにエクスポートしたマッチングを、ポーズを問わず、頂点と面が同じ二つのメッシュに、マッチング直後"
        "のように書き込みます"
    ),
    "What the names of everything that is written start with": "書き込むすべてのものの名前の先頭に付く文字列",
    "Add Demo Pair": "デモ用ペアを追加",
    "Add the same cat twice, in two poses and with two different meshes, to try the matching on": (
        "マッチングを試すために、同じ猫を二つのポーズ、二つの異なるメッシュで追加します"
    ),
    "Source Vertices": "ソースの頂点数",
    "About how many vertices the standing cat gets; its faces are mostly quads": (
        "立っている猫のおおよその頂点数。面はほとんどが四角形です"
    ),
    "Target Vertices": "ターゲットの頂点数",
    "About how many vertices the walking cat gets; its faces are triangles": (
        "歩いている猫のおおよその頂点数。面は三角形です"
    ),
    "Rigged": "リグ付き",
    "Give the standing cat an armature, weights, shape keys and a UV map, to try Retarget on": (
        "リターゲットを試すために、立っている猫にアーマチュア、ウェイト、シェイプキー、UVマップを付けます"
    ),
    "Number": "番号",
    "By which the landmark is known on both meshes": "両方のメッシュでランドマークを識別する番号",
    "Source Vertex": "ソースの頂点",
    "Vertex of the source": "ソースの頂点",
    "Target Vertex": "ターゲットの頂点",
    "Vertex of the target that corresponds to it": "それに対応するターゲットの頂点",
    "Use": "使用",
    "Whether a match keeps to the landmark": "マッチングがこのランドマークを守るかどうか",
    "Which of the matched points it is, from 1": "何番目の対応点か。1から数えます",
    "Vertex of the source that is nearest to the point": "ポイントに最も近いソースの頂点",
    "Vertex of the target that is nearest to the point": "ポイントに最も近いターゲットの頂点",
    "Source Corners": "ソースの角",
    "Vertices around the point": "ポイントの周りの頂点",
    "Source Weights": "ソースのウェイト",
    "Where it is between them": "それらの間での位置",
    "Target Corners": "ターゲットの角",
    "Vertices around the corresponding point": "対応するポイントの周りの頂点",
    "Target Weights": "ターゲットのウェイト",
    (
        "How much the distances from this point to the others differ between the two meshes, in units of the "
        "square root of the surface area"
    ): "このポイントからほかのポイントまでの距離が二つのメッシュの間でどれだけ異なるか。表面積の平方根を単位とします",
    "Locked": "ロック",
    "Whether the point is a landmark, too": "このポイントがランドマークでもあるかどうか",
    "Landmarks": "ランドマーク",
    "Landmarks that source and target have in common": "ソースとターゲットに共通するランドマーク",
    "Landmark": "ランドマーク",
    "The row of the list of landmarks that is active": "ランドマークのリストでアクティブな行",
    "Matched Points": "対応点",
    "The matched points, the worst first": "対応点。悪いものから順に並びます",
    "Matched Point": "対応点",
    "The row of the list of matched points that is active": "対応点のリストでアクティブな行",
    "Before": "以前",
    "What was shown before, as a JSON text; empty if nothing": (
        "以前に表示されていたもの。JSONテキストで、なければ空です"
    ),
    "Revision": "リビジョン",
    "Grows with each change of a list": "リストが変わるたびに増えます",
    "Show in Viewport": "ビューポートに表示",
    "Draw matched points and landmarks on both meshes in the 3D viewports": (
        "3Dビューポートで両方のメッシュに対応点とランドマークを描画します"
    ),
    "Draw the matched points, from blue to yellow by distortion": "対応点を歪みに応じて青から黄の色で描画します",
    "Lines": "ライン",
    "Draw a line between the two places of each point": "各ポイントの二つの位置の間に線を描画します",
    "Numbers": "番号",
    "Write the numbers of landmarks and of the worst points beside them": (
        "ランドマークと最も悪いポイントのそばに番号を表示します"
    ),
    "Add Landmark": "ランドマークを追加",
    (
        "Name two corresponding places, to which matches will keep: in Edit Mode the vertices selected on the two "
        "meshes, one on each; in Object Mode the vertices nearest to two selected empties, or those that you click "
        "on"
    ): (
        "マッチングが守る二つの対応する場所を指定します。編集モードでは二つのメッシュで一つずつ選択した頂点、オ"
        "ブジェクトモードでは選択した二つのエンプティに最も近い頂点、またはクリックした頂点です"
    ),
    "Vertex of the source; if negative, the selected one": "ソースの頂点。負なら選択中の頂点",
    "Vertex of the target; if negative, the selected one": "ターゲットの頂点。負なら選択中の頂点",
    "Name of the object that is the source; if empty, the one picked in the panel or else the active object": (
        "ソースであるオブジェクトの名前。空ならパネルで選んだもの、なければアクティブオブジェクト"
    ),
    "Name of the object that is the target; if empty, the one picked in the panel or else the other selected one": (
        "ターゲットとなるオブジェクトの名前。空なら、パネルで選んだもの、なければ選択したもう一方"
    ),
    "Pick Landmarks": "ランドマークを指定",
    "Guide Me": "案内に従う",
    (
        "Click on nose, hands, feet and tail of both meshes as you are asked for them; S leaves one out. After "
        "the last one, or Enter, the two are matched again with these landmarks"
    ): (
        "求められた順に、両方のメッシュの鼻、手、足、尾をクリックします。Sで飛ばせます。最後まで進むかEnterを"
        "押すと、これらのランドマークでもう一度マッチングします"
    ),
    "Nose": "鼻",
    "Left Hand": "左手",
    "Right Hand": "右手",
    "Left Foot": "左足",
    "Right Foot": "右足",
    "Tail": "尾",
    '{0} ({1} of {2}): click on it on "{3}"    S: leave out': (
        "{0}（{1}/{2}）：「{3}」の上でクリックしてください    S：飛ばす"
    ),
    'Click on "{0}" first, or press S to leave this place out.': (
        "先に「{0}」をクリックするか、Sを押してこの場所を飛ばしてください。"
    ),
    "No landmark was added, so there is nothing new to match by": (
        "ランドマークが加わっていないので、新しくマッチングする手がかりはありません"
    ),
    "Matching again with {0}": "{0}でもう一度マッチングしています",
    "What the landmark is called; double-click to change it": "ランドマークの名前。ダブルクリックで変更できます",
    (
        "Click on a place of one mesh and then on the corresponding place of the other, pair by pair; Enter or Esc "
        "ends it"
    ): (
        "一方のメッシュの場所をクリックし、次にもう一方の対応する場所をクリックして、ペアごとに指定します。Ente"
        "rまたはEscで終了します"
    ),
    "Remove Landmark": "ランドマークを削除",
    "Remove a landmark from both meshes": "両方のメッシュからランドマークを削除します",
    "Which landmark; if zero, the one that is active in the list": (
        "どのランドマークか。0ならリストでアクティブなもの"
    ),
    "Switch Landmark": "ランドマークを切り替え",
    "Switch a landmark on or off; matches keep to those that are on": (
        "ランドマークをオンまたはオフにします。マッチングはオンのものを守ります"
    ),
    "Whether matches are to keep to it": "マッチングがこれを守るかどうか",
    "Select Landmark": "ランドマークを選択",
    "Select the two vertices of a landmark, and nothing else of the two meshes": (
        "二つのメッシュで、ランドマークの二つの頂点だけを選択します"
    ),
    "Clear Landmarks": "ランドマークをクリア",
    "Remove all landmarks that source and target have in common": (
        "ソースとターゲットに共通するすべてのランドマークを削除します"
    ),
    "Mirror Landmarks": "ランドマークをミラー",
    (
        "Add a landmark on the other side for each that is on one side, by the symmetry of each mesh; the meshes "
        "may be in any pose"
    ): (
        "片側にある各ランドマークについて、各メッシュの対称性に従って反対側にも追加します。メッシュのポーズは問いません"
    ),
    "Save Landmarks": "ランドマークを保存",
    "Save the landmarks that source and target have in common to a file": (
        "ソースとターゲットに共通するランドマークをファイルに保存します"
    ),
    "Warn before a file is overwritten": "ファイルを上書きする前に警告します",
    "File": "ファイル",
    "Path of the file, a JSON text": "ファイルのパス（JSONテキスト）",
    "Which files are listed": "表示するファイル",
    "Load Landmarks": "ランドマークを読み込み",
    "Load landmarks of source and target from a file": "ソースとターゲットのランドマークをファイルから読み込みます",
    "Replace": "置き換え",
    "Remove the landmarks that the two meshes have in common before those of the file are added": (
        "ファイルのランドマークを追加する前に、二つのメッシュに共通するランドマークを削除します"
    ),
    "Select Matched Point": "対応点を選択",
    "Select the vertices nearest to a matched point, and nothing else of the two meshes": (
        "二つのメッシュで、対応点に最も近い頂点だけを選択します"
    ),
    "Which matched point; if zero, the one that is active in the list": "どの対応点か。0ならリストでアクティブなもの",
    "Lock Matched Point": "対応点をロック",
    (
        "Make a landmark of a matched point that is right, so that it stays where it is when the match is refined "
        "or made anew; once more lets it go"
    ): "正しい対応点をランドマークにして、改良や再マッチングでも動かないようにします。もう一度実行すると解除します",
    "Remove Matched Point": "対応点を削除",
    "Remove the vertex groups of a matched point from both meshes; the dense map stays as it is": (
        "両方のメッシュから対応点の頂点グループを削除します。密なマップはそのままです"
    ),
    "Refine": "改良",
    (
        "Make the match better around landmarks and locked points, in a fraction of the time of a match. What is "
        "wrong altogether, such as a leg on another leg, has to be matched again"
    ): (
        "ランドマークとロックしたポイントの周りのマッチングを、マッチングのごく一部の時間で改良します。脚が別の"
        "脚に対応しているなど、全体として誤ったものは再マッチングが必要です"
    ),
    "Show": "表示",
    "Show the match in colors in this viewport, or show the meshes as before": (
        "このビューポートでマッチングを色で表示するか、メッシュを元の表示に戻します"
    ),
    "What to show": "表示するもの",
    "Nothing": "なし",
    "Show the meshes as before": "メッシュを元のように表示します",
    "Show corresponding places in the same color": "対応する場所を同じ色で表示します",
    "Show how much lengths differ, from dark blue (none) to yellow": (
        "長さがどれだけ異なるかを、暗い青(差なし)から黄で表示します"
    ),
    "Show in blue what has a counterpart on the other mesh, and in grey what has none": (
        "もう一方のメッシュに対応する場所があるところを青、ないところをグレーで表示します"
    ),
    "Show how far the dense map can be trusted, from dark red to white (fully)": (
        "密なマップをどこまで信頼できるかを、暗い赤から白(完全に)で表示します"
    ),
    "Regions": "領域",
    "Show each vertex in the color of the nearest matched point": "各頂点を最も近い対応点の色で表示します",
    "Checker": "チェッカー",
    "Show checks on the source, and where the dense map takes them on the target": (
        "ソースに市松模様を表示し、密なマップがそれをターゲットのどこに移すかを表示します"
    ),
    "Write Regions": "領域を書き込み",
    (
        "Write a vertex group for each matched point with all vertices that are nearer to it than to any other; "
        "groups of the same name are the same region"
    ): (
        "対応点ごとに、ほかのどれよりもそれに近いすべての頂点を含む頂点グループを書き込みます。同じ名前のグルー"
        "プが同じ領域です"
    ),
    "Done": "完了",
    "What was carried over to which object, one per line": "どのオブジェクトに何を転送したか。一行に一つです",
    "Remarks": "情報",
    "What was left out, or should be known, but is no reason to worry: one sentence per line": (
        "気にする必要のない、除外されたものや知っておくべきこと。一行に一文"
    ),
    "What was left out, or should be known, and why: one sentence per line": (
        "何が省かれたか、または知っておくべきことと、その理由。一行に一文です"
    ),
    "How long it took": "かかった時間",
    "Source Number": "ソースの番号",
    "By what number Blender knows the first object of the source": (
        "Blenderがソースの最初のオブジェクトを識別する番号"
    ),
    "Target Number": "ターゲットの番号",
    "By what number Blender knows the first object of the target": (
        "Blenderがターゲットの最初のオブジェクトを識別する番号"
    ),
    "Session": "セッション",
    "In which session these numbers hold; in others, names are gone by": (
        "これらの番号が有効なセッション。ほかのセッションでは名前で探します"
    ),
    "Refine with Rig": "リグで改良",
    "Accept Doubtful": "疑わしくても書き込む",
    (
        "Write the result also if the match is not to be trusted, with a confidence below 30 percent. In a "
        "window you are asked"
    ): "マッチングが信頼できない（信頼度が30％未満の）場合にも結果を書き込みます。ウィンドウでは確認されます",
    "How far the matches can be trusted, one sentence per line; empty if that is unknown": (
        "マッチングをどこまで信頼できるか。一行に一文。不明な場合は空"
    ),
    "Doubtful": "疑わしい",
    "Whether one of the matches is not to be trusted": "信頼できないマッチングがあるかどうか",
    (
        "If the source has a rig, fit it into the target and make the map of the match better with it, once for "
        "each match. It takes some seconds, and weights, joints and shape keys gain much"
    ): (
        "ソースにリグがあれば、それをターゲットに合わせ、マッチングのマップをそれによって改良します。マッチング"
        "ごとに一度だけです。数秒かかりますが、ウェイト、関節、シェイプキーが大きく向上します"
    ),
    "Report": "レポート",
    "What became of the last transfer": "最後の転送の結果",
    "Reports": "レポート一覧",
    "What became of the last transfer of each panel, by the panel's identifier": (
        "各パネルの最後の転送の結果。パネルの識別子ごと"
    ),
    "Rig": "リグ",
    (
        "Give the target a copy of the source's armature, fitted into its body, and bind it. Left out if the "
        "source has none"
    ): "ソースのアーマチュアのコピーをターゲットの体に合わせて与え、バインドします。ソースになければ省かれます",
    "Weights": "ウェイト",
    "Carry the source's vertex groups. Left out if it has none": (
        "ソースの頂点グループを転送します。なければ省かれます"
    ),
    "Shape Keys": "シェイプキー",
    "Carry the source's shape keys. Left out if it has none": "ソースのシェイプキーを転送します。なければ省かれます",
    "UV Maps": "UVマップ",
    "Carry the source's UV maps. Left out if it has none": "ソースのUVマップを転送します。なければ省かれます",
    "Attributes": "属性",
    "Carry color attributes, custom attributes, materials and marked edges": (
        "カラー属性、カスタム属性、マテリアル、マークした辺を転送します"
    ),
    "Existing Rig": "既存のリグ",
    "What becomes of an armature that was made for the target before": (
        "以前ターゲットのために作ったアーマチュアの扱い"
    ),
    "Update": "更新",
    "Move its joints; all else that was changed on it since stays": (
        "関節を動かします。それ以降に変更したほかのものはそのままです"
    ),
    "Keep": "維持",
    "Leave it as it is, and make another one": "そのままにして、別のものを作ります",
    "Replace Own Rig": "自身のリグを置き換え",
    (
        "If the target has a rig of its own already, switch its Armature modifiers off, and hide it if it moves "
        "nothing else; it is not deleted. Otherwise both move the target"
    ): (
        "ターゲットに自身のリグがすでにある場合、そのアーマチュアモディファイアーをオフにし、ほかに動かすものがなけ"
        "れば隠します。削除はしません。オフにすると、両方がターゲットを動かします"
    ),
    '"{0}" is no longer moved by its own armature "{1}", whose Armature modifiers are switched off.': (
        "「{0}」は自身のアーマチュア「{1}」ではもう動きません。そのアーマチュアモディファイアーはオフになっています。"
    ),
    '"{0}" had "{1}" posed. That pose was left out: the rest pose of its own armature counts. To keep the pose '
    "instead, undo, apply that Armature modifier, and fit the rig again.": (
        '"{0}"は"{1}"にポーズを付けていましたが、そのポーズは移されず、自身のアーマチュアのレストポーズが使われま'
        "した。ポーズを残すには、元に戻してそのアーマチュアモディファイアーを適用し、もう一度リグを合わせてくださ"
        "い。"
    ),
    'What it wears is still moved by "{0}": {1}. Fit it again by Wear.': (
        '着ているものはまだ"{0}"で動きます: {1}。「着せる」でもう一度合わせてください。'
    ),
    "Bind": "バインド",
    "Same Rest Pose": "同じレストポーズ",
    (
        "Whether to bring the target to the rest pose of the source, so that the source's actions play on "
        "it. How it stood is kept as an action"
    ): (
        "ターゲットをソースのレストポーズにして、ソースのアクションがそのまま再生されるようにするかどうか。元"
        "の立ち方はアクションとして残ります"
    ),
    "If It Has Actions": "アクションがあれば",
    "If the rig of the source has an action or strips of actions": (
        "ソースのリグにアクションまたはアクションストリップがある場合"
    ),
    "Always": "常に",
    "Also for actions that are to come later": "後から作るアクションのためにも",
    "Never": "しない",
    "The pose that the target stands in becomes its rest pose": "ターゲットの今のポーズがレストポーズになります",
    "Rest Pose": "レストポーズ",
    "a rest pose like the source's": "ソースと同じレストポーズ",
    (
        '"{0}" has the rest pose of "{1}" now, in which the actions of "{2}" play. How it stood is kept as '
        'the action "{3}".'
    ): (
        "「{0}」は「{1}」のレストポーズになり、「{2}」のアクションが再生できます。元の立ち方はアクション「{3}"
        "」に残してあります。"
    ),
    'What "{0}" wears stands as before: {1}. Fit it again by Wear.': (
        '"{0}"が着ているものは元の立ち方のままです: {1}。「着せる」でもう一度合わせてください。'
    ),
    "The rest pose stays as it was, and the source's actions do not play as they should: {0}.": (
        "レストポーズは元のままで、ソースのアクションは正しく再生されません。理由：{0}。"
    ),
    '"{0}" is moved by the armature "{1}" as well': "「{0}」はアーマチュア「{1}」にも動かされています",
    '"{0}" has no weights for the bones of "{1}"': "「{0}」には「{1}」のボーンのウェイトがありません",
    '"{0}" shares its mesh data with other objects': "「{0}」はメッシュデータを他のオブジェクトと共有しています",
    (
        "Give the target an Armature modifier, set as the source's, and the armature as its parent if the source "
        "has its own as parent"
    ): (
        "ソースと同じ設定のアーマチュアモディファイアーをターゲットに付け、ソースが自分のアーマチュアを親にして"
        "いれば、ターゲットもアーマチュアを親にします"
    ),
    "Also Rest Pose": "レストポーズも",
    "If the target is in another pose than the source, make an action that takes it to a rest pose like the source's": (
        "ターゲットがソースと違うポーズなら、ソースと同様のレストポーズに戻すアクションを作ります"
    ),
    "Show Rest Pose": "レストポーズを表示",
    "Let the new armature take that rest pose at once": "新しいアーマチュアをすぐにそのレストポーズにします",
    "Pose": "ポーズ",
    "Whether the target is in another pose than the source, for the rest pose": (
        "レストポーズのために、ターゲットがソースと違うポーズかどうか"
    ),
    "Automatic": "自動",
    "It is, if a large limb is bent much against the source": (
        "大きな手足がソースに対して大きく曲がっていれば、違うとみなします"
    ),
    "Posed": "ポーズあり",
    "It is: undo all rotations of its bones": "違うポーズです。すべてのボーンの回転を取り消します",
    "At Rest": "レスト状態",
    "It is in its rest pose already, and only its build is different": "すでにレストポーズで、体格だけが異なります",
    "Which vertex groups of the source are carried over. Those that a match wrote never are": (
        "ソースのどの頂点グループを転送するか。マッチングが書き込んだものは転送しません"
    ),
    "All": "すべて",
    "All vertex groups": "すべての頂点グループ",
    "Deforming Bones": "変形ボーン",
    "The vertex groups of bones that deform": "変形するボーンの頂点グループ",
    "Selected Bones": "選択したボーン",
    "The vertex groups of the bones that are selected in the source's rig": (
        "ソースのリグで選択しているボーンの頂点グループ"
    ),
    "Active": "アクティブ",
    "The active vertex group": "アクティブな頂点グループ",
    "Mode": "モード",
    "What becomes of the weights that the target has in these groups": (
        "これらのグループでターゲットが持つウェイトの扱い"
    ),
    "The carried weights take their place": "転送したウェイトで置き換えます",
    "Add": "加算",
    "The carried weights are added to them": "転送したウェイトを加えます",
    "Mix Factor": "ミックス係数",
    "How much the carried weights count against those that are there": (
        "既存のウェイトに対して転送したウェイトをどれだけ重視するか"
    ),
    "Normalize": "正規化",
    (
        "Let the weights of all bones sum to one at each vertex. Locked groups keep theirs. If only some groups "
        "are carried, the others of the target give way to them"
    ): (
        "各頂点ですべてのボーンのウェイトの合計を1にします。ロックしたグループは変わりません。一部のグループだ"
        "けを転送する場合は、ターゲットのほかのグループが譲ります"
    ),
    "Limit": "制限",
    "How many bones may move a vertex: the smallest weights go, and fade before they do. 0 for any number": (
        "一つの頂点を動かせるボーンの数。最小のウェイトから、しだいに弱めて除かれます。0で無制限"
    ),
    "Clean": "クリーン",
    "Weights below this are dropped, but for the largest of each vertex": (
        "これより小さいウェイトは、各頂点の最大のものを除いて削除されます"
    ),
    "Fill": "フィル",
    ("Where the map tears vertices away from their neighbors, take the weights from around them along the surface"): (
        "マップが頂点を隣から引き離した場所では、表面に沿って周囲のウェイトを使います"
    ),
    "Rigid Pieces": "剛体の部品",
    (
        "Let loose pieces move as one, such as eyes, teeth, buckles and plates, if what they correspond to does on "
        "the source"
    ): ("目、歯、バックル、装甲板のような独立した部品を、ソースの対応する部分がそうなら一体として動くようにします"),
    "Rigid Group": "剛体グループ",
    (
        "Vertex group of the target for single pieces: a loose piece with vertices of weight 1 in it moves by one "
        "bone, one with vertices of weight 0 never moves as one, whatever the source does"
    ): (
        "個々の部品を指定するターゲットの頂点グループ。ウェイト1の頂点がある独立部品は一つのボーンで動き、ウェイト0の頂点"
        "がある部品は、ソースにかかわらず一体としては動きません"
    ),
    "No Counterpart": "対応のない場所",
    "Follow the Map": "マップに従う",
    (
        "What vertices get that have no counterpart on the source, as Show > Overlap tells: where the target shows "
        "more of a body than the source"
    ): (
        "ソースに対応する場所がない頂点（「表示 > 重なり」でわかります）をどうするか。ターゲットがソースより体の"
        "多くの部分を含む場合に使います"
    ),
    "The weights of the nearest place that the map leads to": "マップが指す最も近い場所のウェイト",
    "The weights of the vertices around them that have a counterpart": "周囲の、対応のある頂点のウェイト",
    "Their weights stay as they are": "ウェイトはそのまま",
    "Mark Rejected": "除外をマーク",
    (
        "Write a color attribute that shows in red which vertices were torn away from their neighbors, so that "
        "their own weights were rejected"
    ): "隣から引き離され、自身のウェイトが使われなかった頂点を赤で示すカラー属性を書き込みます",
    "Which shape keys of the source are carried over": "ソースのどのシェイプキーを転送するか",
    "All shape keys": "すべてのシェイプキー",
    "The active shape key": "アクティブなシェイプキー",
    "By Name": "名前",
    "The shape keys that are named": "名前を指定したシェイプキー",
    "Names": "名前",
    "Names of the shape keys to carry over, separated by commas": "転送するシェイプキーの名前。コンマで区切ります",
    "Existing Keys": "既存のキー",
    "What becomes of shape keys of the same name that the target has already": (
        "ターゲットがすでに持つ同名のシェイプキーの扱い"
    ),
    "Give them the new shape and settings": "新しい形状と設定を与えます",
    "Skip": "スキップ",
    "Leave them as they are": "そのまま残します",
    "Scale": "スケール",
    "What becomes of the size of the movements": "動きの大きさの扱い",
    "With Size if the target is clearly larger or smaller than the source, else only to its units": (
        "ターゲットがソースより明らかに大きいか小さければ「サイズに合わせる」、そうでなければ単位だけを合わせる"
    ),
    "None": "なし",
    "As long as on the source": "ソースと同じ長さ",
    "With Size": "サイズに合わせる",
    "Longer or shorter as the whole target is larger or smaller": (
        "ターゲット全体の大きさに応じて長くまたは短くします"
    ),
    "Locally": "局所的",
    "Longer or shorter as the target is larger or smaller around each place": (
        "各場所の周りのターゲットの大きさに応じて長くまたは短くします"
    ),
    "Threshold": "しきい値",
    (
        "Movements shorter than this part of the longest of a shape key are dropped, so that vertices far from "
        "what it moves stay exactly in place"
    ): (
        "シェイプキーの最長の動きに対してこの割合より短い動きは捨てられ、動く場所から遠い頂点は正確にその場に留まります"
    ),
    "Drivers": "ドライバー",
    (
        "Copy the drivers of the shape keys. Where they point to the source or its armature, the copies point to "
        "the target and its armature"
    ): (
        "シェイプキーのドライバーをコピーします。ソースまたはそのアーマチュアを参照している箇所は、ターゲットと"
        "そのアーマチュアを参照します"
    ),
    "Action": "アクション",
    "Let the target's shape keys play the action of the source's, unless they have one of their own. Both share it": (
        "ターゲットのシェイプキーに独自のアクションがなければ、ソースのシェイプキーのアクションで動かします。"
        "アクションは両者で共有されます"
    ),
    "Which UV maps of the source are carried over. Those of the same name are replaced": (
        "ソースのどのUVマップを転送するか。同名のものは置き換えられます"
    ),
    "All UV maps": "すべてのUVマップ",
    "The active UV map": "アクティブなUVマップ",
    "The UV maps that are named": "名前を指定したUVマップ",
    "Names of the UV maps to carry over, separated by commas": "転送するUVマップの名前。コンマで区切ります",
    "Mark Seams": "シームをマーク",
    (
        "Mark the edges between the islands of the active UV map as seams on the target, instead of the seams that "
        "it has"
    ): "ターゲットの既存のシームの代わりに、アクティブなUVマップのアイランドの境界の辺をシームとしてマークします",
    "Color Attributes": "カラー属性",
    "Carry color attributes over; those of the same name are replaced": (
        "カラー属性を転送します。同名のものは置き換えられます"
    ),
    "Other Attributes": "その他の属性",
    "Carry over attributes of numbers, vectors and truth values that were added to the source": (
        "ソースに追加された数値、ベクトル、ブール値の属性を転送します"
    ),
    "Names of the attributes to carry over, separated by commas; if empty, all": (
        "転送する属性の名前。コンマで区切ります。空ならすべて"
    ),
    "Materials": "マテリアル",
    (
        "Give each face the material of the source there; materials are added to the slots of the target unless "
        "they are there already"
    ): "各面にソースのその場所のマテリアルを与えます。まだなければターゲットのスロットに追加されます",
    "Sharp Edges": "シャープな辺",
    (
        "Mark the edges as sharp that follow sharp edges of the source, and shade faces flat where the source is, "
        "instead of what is marked on the target"
    ): (
        "ターゲットの既存のマークの代わりに、ソースのシャープ辺に沿う辺をシャープにし、ソースがフラットな場所の"
        "面をフラットにします"
    ),
    "Seams": "シーム",
    (
        "Mark the edges as seams that follow seams of the source, instead of those of the target. UV maps that are "
        "carried over bring their own"
    ): (
        "ターゲットのシームの代わりに、ソースのシームに沿う辺をシームとしてマークします。転送されるUVマップは独"
        "自のシームを伴います"
    ),
    "Creases and Bevels": "クリースとベベル",
    "Carry creases and bevel weights over to the edges and vertices that follow those of the source": (
        "クリースとベベルウェイトを、ソースのものに沿う辺と頂点に転送します"
    ),
    "Custom Normals": "カスタム法線",
    "Carry over how the custom normals of the source deviate from its surface, if it has any": (
        "ソースにカスタム法線があれば、その表面からのずれを転送します"
    ),
    "Wrap": "ラップ",
    "Whose surface is laid onto the other": "どちらの表面をもう一方に重ねるか",
    "Source to Target": "ソースをターゲットへ",
    "Lay the source onto the target": "ソースをターゲットに重ねます",
    "Target to Source": "ターゲットをソースへ",
    "Lay the target onto the source": "ターゲットをソースに重ねます",
    "Result": "結果",
    "What is made": "作成するもの",
    "Shape Key": "シェイプキー",
    "Add a shape key to the mesh: its slider leads from one shape to the other": (
        "メッシュにシェイプキーを追加します。スライダーで一方の形からもう一方へ変化します"
    ),
    "New Object": "新規オブジェクト",
    "Make a new object that has both shapes, and leave the mesh as it is": (
        "両方の形を持つ新しいオブジェクトを作り、メッシュはそのままにします"
    ),
    "Place": "位置",
    "Where the wrapped shape stands": "ラップした形状を置く場所",
    "At the Other": "相手の位置",
    "Where the mesh stands that it is laid onto": "重ねる相手のメッシュの場所",
    "Own Place": "自身の位置",
    "Where the mesh stood, turned and moved back as one": (
        "メッシュがあった場所。全体を一つとして回転、移動して戻します"
    ),
    "In-Betweens": "中間形状",
    (
        "How many shape keys are added that keep limbs from shrinking on the way. They follow the slider of the "
        "first by drivers"
    ): "途中で手足が縮まないように追加するシェイプキーの数。ドライバーによって最初のキーのスライダーに従います",
    "Direction": "方向",
    (
        "Which side is taken to the other. The sides are told apart by vertex groups with names such as Arm.L and "
        "Arm.R, or else by the object's X axis, which points to the left"
    ): (
        "どちらの側を反対側に写すか。左右はArm.LとArm.Rのような名前の頂点グループ、なければ左を指すオブジェクト"
        "のX軸で区別します"
    ),
    "Left to Right": "左から右",
    "The left side is good": "左側が正しい",
    "Right to Left": "右から左",
    "The right side is good": "右側が正しい",
    "Make the weights of vertex groups symmetric; locked groups are left alone": (
        "頂点グループのウェイトを対称にします。ロックしたグループはそのままです"
    ),
    "Make shape keys symmetric": "シェイプキーを対称にします",
    "Colors": "色",
    "Make color attributes symmetric": "カラー属性を対称にします",
    "Create Missing Sides": "欠けた側を作成",
    "Add vertex groups and shape keys of the other side where only one side is there": (
        "片側しかない場合に、反対側の頂点グループとシェイプキーを追加します"
    ),
    "Retarget": "リターゲット",
    (
        "Match the source with the target if that has not been done, and carry its rig, weights, shape keys and UV "
        "maps over, whatever the pose, build and topology of the target"
    ): (
        "まだならソースとターゲットをマッチングし、ターゲットのポーズ、体格、トポロジーを問わず、リグ、ウェイト"
        "、シェイプキー、UVマップを転送します"
    ),
    "Name of the object to carry to; if empty, the one picked in the panel or else all other selected meshes": (
        "転送先のオブジェクトの名前。空ならパネルで選んだもの、なければほかの選択中のすべてのメッシュ"
    ),
    "Targets": "ターゲット",
    "Names of several objects to carry to": "複数の転送先のオブジェクトの名前",
    "What the names start with that the match to use wrote; if empty, the one match that the objects carry": (
        "使用するマッチングが書き込んだ名前の先頭。空ならオブジェクトが持つ唯一のマッチング"
    ),
    "Fit Rig": "リグをフィット",
    (
        "Give the matched meshes a copy of the source's armature each, with its joints where they belong in their "
        "pose and build, and bind them to it"
    ): (
        "マッチングしたメッシュそれぞれにソースのアーマチュアのコピーを与え、そのポーズと体格に合った位置に関節"
        "を置き、バインドします"
    ),
    "Transfer Weights": "ウェイトを転送",
    "Carry the source's vertex groups to the matched meshes, whatever their pose and topology": (
        "ポーズやトポロジーを問わず、ソースの頂点グループをマッチングしたメッシュに転送します"
    ),
    "Transfer Shape Keys": "シェイプキーを転送",
    (
        "Carry the source's shape keys to the matched meshes, whatever their pose and topology, with their values, "
        "ranges and drivers"
    ): (
        "ポーズやトポロジーを問わず、ソースのシェイプキーを値、範囲、ドライバーとともにマッチングしたメッシュに"
        "転送します"
    ),
    "Transfer UVs": "UVを転送",
    (
        "Carry the source's UV maps to the matched meshes, whatever their pose and topology, so that its textures "
        "fit them. Islands stay islands: no face is smeared across a seam"
    ): (
        "ポーズやトポロジーを問わず、ソースのUVマップをマッチングしたメッシュに転送し、テクスチャが合うようにし"
        "ます。アイランドは保たれ、シームをまたいで引き伸ばされる面はありません"
    ),
    "Transfer Attributes": "属性を転送",
    (
        "Carry color and other attributes, materials, sharp edges, creases and custom normals of the source to the "
        "matched meshes, whatever their pose and topology"
    ): (
        "ポーズやトポロジーを問わず、ソースのカラー属性などの属性、マテリアル、シャープ辺、クリース、カスタム法"
        "線をマッチングしたメッシュに転送します"
    ),
    (
        "Lay the source onto the matched mesh, as a shape key whose slider morphs one into the other. Parts that "
        "the other mesh lacks follow their surroundings"
    ): (
        "マッチングしたメッシュにソースを重ね、スライダーで一方からもう一方へモーフするシェイプキーにします。相"
        "手にない部分は周囲に従います"
    ),
    "Turn": "回転",
    "How the target's surface is turned against the source's at rest, in the spaces of the armatures": (
        "レスト時にターゲットの表面がソースに対してどれだけ回転しているか。アーマチュアの空間での値です"
    ),
    "Source Bone": "ソースのボーン",
    "Bone of the source; empty for none": "ソースのボーン。ない場合は空にします",
    "Target Bone": "ターゲットのボーン",
    "Bone of the target that stands for it": "それに対応するターゲットのボーン",
    "Where the head of the source bone lies in the target, in the target armature's space": (
        "ソースのボーンのヘッドがターゲットのどこにあるか。ターゲットのアーマチュアの空間での値です"
    ),
    "Lock": "ロック",
    "Keep this row when bones are paired again; without a source, the bone stays alone": (
        "ボーンを再びペアにするときこの行を保ちます。ソースがなければ、そのボーンは単独のままです"
    ),
    "Standing": "立ち方",
    "How the target stands, turned against the source, in the spaces of the armatures": (
        "ターゲット全体がソースに対してどれだけ回転して立っているか。アーマチュアの空間での値です"
    ),
    "Source Rig": "ソースのリグ",
    "Armature of the source": "ソースのアーマチュア",
    "Target Rig": "ターゲットのリグ",
    "Armature of the target": "ターゲットのアーマチュア",
    "Score": "スコア",
    "How well the two agree, from 0 to 1": "二つがどれだけ一致するか。0から1",
    "Source Bone at Rest": "ソースボーンのレスト位置",
    "Head, tail and a point beside the head of the source bone when turn and place were seen": (
        "向きと位置を確認したときの、ソースボーンのヘッド、テール、ヘッドの横の点"
    ),
    "Target Bone at Rest": "ターゲットボーンのレスト位置",
    "Head, tail and a point beside the head of the target bone when turn and place were seen": (
        "向きと位置を確認したときの、ターゲットボーンのヘッド、テール、ヘッドの横の点"
    ),
    "Seen": "表面で確認",
    "Whether turn and place were seen on the surface; a row made by hand has none": (
        "回転と位置が表面から求められたかどうか。手で作った行にはありません"
    ),
    "Pair": "ペア",
    "The row of the table of bones that is active": "ボーンの表でアクティブな行",
    "Tolerance": "許容誤差",
    "By how much reduced keys may change a rotation": "キーの削減で回転がどれだけ変わってよいか",
    "Actions": "対象アクション",
    "Which actions of the source are carried over": "ソースのどのアクションを移すか",
    "The one that the source plays, or the only one that it has": "ソースが再生しているもの、または唯一のもの",
    "All actions of the file that move bones of the source": "ソースのボーンを動かす、ファイル内のすべてのアクション",
    "Keys": "キー",
    "At which frames the new action gets keys": "新しいアクションがどのフレームにキーを持つか",
    "At the source's keys if these are few, else reduced ones": (
        "ソースのキーが少なければその位置に、多ければ削減したキー"
    ),
    "As the Source": "ソースと同じ",
    "At the keys of the source's bones, with their interpolation": "ソースのボーンのキーの位置に、その補間で",
    "Reduced": "削減",
    "As few as keep the motion within the Tolerance": "モーションを許容誤差内に保つ最少のキー",
    "Every Frame": "全フレーム",
    "At every frame": "すべてのフレームに",
    "Stride": "歩幅",
    "How long the way along the ground is; 1 fits the length of the target's legs": (
        "地面に沿った移動の長さ。1でターゲットの脚の長さに合います"
    ),
    "In Place": "その場で",
    "Take out the way from the first to the last frame, for walk cycles": (
        "最初から最後のフレームまでの移動を取り除きます。歩行サイクル用です"
    ),
    "Feet on Ground": "足を地面に保つ",
    "Where a foot stands in the source, let it stand in the target: the leg is bent for it. All frames "
    "are computed then": (
        "ソースで足が立っているところでは、ターゲットの足も動かないように脚を曲げます。全フレームが計算されます"
    ),
    "Hands on Body": "手を体に保つ",
    "Where a hand touches the body or the other hand in the source, bend the target's arm so that it "
    "does so too. All frames are computed then": (
        "ソースで手が体や反対の手に触れているところでは、ターゲットの手も触れるように腕を曲げます。全フレームが計"
        "算されます"
    ),
    "Pair Bones": "ボーンをペアにする",
    "Find out which bones of two rigs belong together by the surface that they move, whatever they are "
    "called. The bodies are matched first if that has not been done": (
        "二つのリグのどのボーンが対応するかを、名前に関係なく、動かす表面から求めます。体がまだマッチングされてい"
        "なければ先に行います"
    ),
    "Retarget Action": "アクションをリターゲット",
    "Carry actions of the source's armature to others, whatever their bones are called, how many there "
    "are, and how they rest. Bones are paired first if that has not been done": (
        "ソースのアーマチュアのアクションを、ボーンの名前や数やレストポーズに関係なく、他のアーマチュアに移します"
        "。ボーンがまだペアになっていなければ先に行います"
    ),
    "Name of the action to carry over, or a pattern such as Walk*; several with a semicolon between "
    "them. If empty, those that Actions says": (
        "引き継ぐアクションの名前、または Walk* のようなパターン。複数ならセミコロンで区切ります。空なら「ア"
        "クション」の指すもの"
    ),
    "NLA Strips": "NLAストリップ",
    "Carry the actions of the source's NLA strips over as well, and copy the strips": (
        "ソースのNLAストリップのアクションも移し、ストリップをコピーします"
    ),
    "Play": "再生",
    "Let the target play the new action, if it is one only": (
        "新しいアクションが一つだけなら、ターゲットに再生させます"
    ),
    "Retarget Pose": "ポーズをリターゲット",
    "Pose other armatures as the source's stands now. Bones are paired first if that has not been done": (
        "他のアーマチュアをソースの現在のポーズにします。ボーンがまだペアになっていなければ先に行います"
    ),
    "Where a hand touches the body or the other hand in the source, bend the target's arm so that it does so too": (
        "ソースで手が体や反対の手に触れているところでは、ターゲットの手も触れるように腕を曲げます"
    ),
    "Add Bone Pair": "ボーンのペアを追加",
    "Pair two bones by hand, and lock the pair; without a source bone, the target's bone stays alone": (
        "二つのボーンを手でペアにしてロックします。ソースのボーンがなければ、ターゲットのボーンは単独のままです"
    ),
    "Bone of the target; if empty, the active bones of both armatures are paired": (
        "ターゲットのボーン。空なら、両方のアーマチュアのアクティブなボーンをペアにします"
    ),
    "Remove Bone Pair": "ボーンのペアを削除",
    "Take a pair of bones out of the table": "ボーンのペアを表から取り除きます",
    "Remove its pair with this bone only; if empty, all": "このボーンとのペアだけを削除します。空ならすべて",
    "Bone of the target whose pairs are removed": "ペアを削除するターゲットのボーン",
    "Clear Bone Pairs": "ボーンのペアを消去",
    "Take the pairs of two armatures out of the table": "二つのアーマチュアのペアを表から取り除きます",
    "Locked Too": "ロックも含む",
    "Take locked pairs out as well": "ロックされたペアも取り除きます",
    "Export Bone Pairs": "ボーンのペアを書き出し",
    "Save the pairs of bones of two armatures to a file, for other files with the same rigs": (
        "二つのアーマチュアのボーンのペアをファイルに保存します。同じリグを使う他のファイルのためです"
    ),
    "Import Bone Pairs": "ボーンのペアを読み込み",
    "Load pairs of bones from a file in place of those of two armatures": (
        "二つのアーマチュアのペアの代わりに、ファイルからボーンのペアを読み込みます"
    ),
    "Weights to Own Rig": "自身のリグへのウェイト",
    "Carry the source's weights to the bones that the target has already, through the pairs of bones: "
    "they are shared out where it has more bones, and added up where it has fewer": (
        "ソースのウェイトを、ボーンのペアを通じて、ターゲットがすでに持つボーンに移します。ボーンが多いところでは"
        "分配し、少ないところでは合計します"
    ),
    "Pair the bones first": "先にボーンをペアにしてください",
    "Limit Bones": "ボーン数を制限",
    "How many bones may move a vertex at most; 0 for any number": "一つの頂点を動かせるボーンの最大数。0なら無制限",
    "Motion": "モーション",
    'The rotation of {0} of "{1}" is locked. Unlock it (in the sidebar: Item), or clear these bones in '
    "the table of pairs.": (
        '"{1}"の{0}の回転がロックされています。ロックを解除するか(サイドバー: '
        "アイテム)、ペアの表からこれらのボーンを消してください。"
    ),
    'Constraints hold {0} of "{1}", so they may not follow the new motion. Mute them to see it.': (
        'コンストレイントが"{1}"の{0}を拘束しているため、新しいモーションに従わないことがあります。見るにはミュー'
        "トしてください。"
    ),
    'Drivers turn {0} of "{1}", which therefore do not follow the new motion. Mute them to see it.': (
        'ドライバーが"{1}"の{0}を回転させているため、新しいモーションに従いません。見るにはミュートしてください。'
    ),
    "Pairs of bones that are gone, or called otherwise by now, were left out: {0}. Pair the bones again.": (
        "なくなったか、名前が変わったボーンのペアは除外されました: {0}。ボーンをもう一度ペアにしてください。"
    ),
    'The rest pose has changed since bones were paired, and these go by how they lie now: {0} of "{1}". Pair the bones '
    "again.": (
        'ボーンをペアにした後でレストポーズが変わったため、次のボーンは現在の向きに従います: "{1}"の{0}。ボーンを'
        "もう一度ペアにしてください。"
    ),
    'Bones without a pair that are not at rest turn all that hangs on them: {0} of "{1}". Clear their pose (Pose > '
    "Clear Transform) unless that is wanted.": (
        'ペアがなく、レストポーズでもないボーンが、付いているものをすべて回転させています: "{1}"の{0}。意図したもので'
        "なければ、そのポーズをクリアしてください(ポーズ > トランスフォームをクリア)。"
    ),
    'Auto Keying set no keys: "{0}" plays an action of another file. Make it local, or let it play another one.': (
        '自動キー挿入はキーを打ちませんでした: "{0}"が別のファイルのアクションを再生しているためです。ローカル化'
        "するか、別のアクションを再生させてください。"
    ),
    '"{0}" was edited since it had been made. The edited one is kept as "{1}".': (
        "「{0}」は移された後に編集されていました。編集されたものは「{1}」として残してあります。"
    ),
    'Actions that move only the object "{0}", and none of its bones, were left out: {1}.': (
        'オブジェクト"{0}"だけを動かし、ボーンを動かさないアクションは移されませんでした: {1}。'
    ),
    '{0} changes the size of the object "{1}", too. That was left out.': (
        '{0}はオブジェクト"{1}"のサイズも変えます。それは移されませんでした。'
    ),
    'All frames of {0} were computed: with keys only where the source has some "{1}" would move otherwise in '
    "between.": (
        '{0}のすべてのフレームを計算しました: ソースのキーの位置だけにキーを打つと、"{1}"はその間で違う動きになります。'
    ),
    '{0} of "{1}" will stay beyond the last key, where the source turns on: quaternions do not go on as Euler angles '
    "do. Give these bones the rotation modes that those of the source have, and carry it again.": (
        '"{1}"の{0}は最後のキーで止まりますが、ソースはその後も回り続けます: '
        "クォータニオンはオイラー角のようには続きません。"
        "これらのボーンの回転モードをソースのボーンと同じにして、もう一度移してください。"
    ),
    "In the place of meta strips the strips within them were copied: {0}.": (
        "メタストリップの代わりに、その中のストリップをコピーしました: {0}。"
    ),
    "Bones that are connected do not move away from what they hang on, as those of the source do: {0} of "
    '"{1}". To carry that as well disconnect them (Armature > Parent > Disconnect Bone in Edit Mode).': (
        '接続されたボーンは、ソースのボーンのように親から離れて動きません: "{1}"の{0}。それも移すには、'
        "接続を解除してください(編集モードでアーマチュア > ペアレント > ボーンを切り離す)。"
    ),
    'The sizes that bones of "{0}" get were left out: {1}.': '"{0}"のボーンのサイズの変化は移されませんでした: {1}。',
    'The action "{0}" was deleted meanwhile. Nothing was written.': (
        'アクション"{0}"がその間に削除されました。何も書き込まれていません。'
    ),
    'Source and Target are both "{0}". Choose two different armatures.': (
        'ソースとターゲットがどちらも"{0}"です。異なる二つのアーマチュアを選んでください。'
    ),
    "Reading motion": "モーションを読み込み中",
    "Pairing bones": "ボーンをペアにしています",
    'No bone of "{0}" moves what one of "{1}" moves. Check the match, and that both meshes have weights.': (
        '"{0}"のどのボーンも、"{1}"のボーンが動かすところを動かしません。マッチングと、両方のメッシュにウェイトが'
        "あることを確認してください。"
    ),
    'The bones of "{0}" were changed meanwhile. Nothing was written.': (
        '"{0}"のボーンがその間に変更されました。何も書き込まれていません。'
    ),
    '"{0}" of "{1}" is not in the table of pairs.': '"{1}"の"{0}"はペアの表にありません。',
    "Which bones are meant is open. Make one bone of each armature active, in Pose Mode.": (
        "どのボーンか不明です。ポーズモードで、それぞれのアーマチュアのボーンを一つアクティブにしてください。"
    ),
    "Carrying motion over": "モーションを移しています",
    '"{0}" has no action that moves its bones, but there are some of {1}. Exchange Source and Target, or name an '
    "action.": (
        '"{0}"にはボーンを動かすアクションがありませんが、{1}にはあります。ソースとターゲットを入れ替えるか、アクション名を指定してください。'
    ),
    '"{0}" has no action that moves its bones. Give it one, or name an action.': (
        '"{0}"にはボーンを動かすアクションがありません。割り当てるか、アクションを指定してください。'
    ),
    '"{0}" plays "{1}", which moves none of its bones. Name one of these, or choose all: {2}.': (
        '"{0}"が再生している"{1}"はボーンを動かしません。次のいずれかを指定するか、すべてを選んでください：{2}。'
    ),
    '"{0}" plays no action. Name one of these, or choose all: {1}.': (
        '"{0}"はアクションを再生していません。次のいずれかを指定するか、すべてを選んでください：{1}。'
    ),
    'The action "{0}" moves no bone of "{1}". Choose one that does.': (
        'アクション"{0}"は"{1}"のボーンを動かしません。動かすものを選んでください。'
    ),
    'No action that moves bones of "{0}" fits the pattern "{1}". Its actions are {2}.': (
        '"{0}"のボーンを動かすアクションで、パターン"{1}"に合うものがありません。あるアクションは{2}です。'
    ),
    'No bones of "{0}" and "{1}" are paired. Pair their bones first.': (
        '"{0}"と"{1}"のボーンはペアになっていません。先にペアにしてください。'
    ),
    'No pair of the file fits the bones of "{0}" and "{1}".': (
        'ファイルのどのペアも"{0}"と"{1}"のボーンに合いません。'
    ),
    '"{0}" has no bone called "{1}".': '"{0}"に"{1}"というボーンはありません。',
    "The file holds no pairs of bones. Choose one that was exported from HierMatch.": (
        "ファイルにボーンのペアがありません。HierMatchから書き出したものを選んでください。"
    ),
    'There is no action called "{0}". Those of "{1}" are {2}.': (
        '"{0}"というアクションはありません。"{1}"のアクションは{2}です。'
    ),
    '"{0}" has no armature. Choose an armature, or a mesh with an Armature modifier.': (
        '"{0}"にアーマチュアがありません。アーマチュアか、アーマチュアモディファイアーを持つメッシュを選んでください。'
    ),
    'The armature "{0}" has no bones.': 'アーマチュア"{0}"にボーンがありません。',
    'The armature "{0}" is linked from another file and cannot be animated here. Make a library override of its '
    "character first (Object > Library Override > Make).": (
        'アーマチュア"{0}"は他のファイルからリンクされているため、ここではアニメーションできません。先にキャラクター'
        "のライブラリオーバーライドを作成してください(オブジェクト > ライブラリオーバーライド > 作成)。"
    ),
    'The armature "{0}" is a library override that cannot be edited. Make it editable first '
    "(Object > Library Override > Make).": (
        'アーマチュア"{0}"は編集できないライブラリオーバーライドです。先に編集可能にしてください(オブジェクト > '
        "ライブラリオーバーライド > 作成)。"
    ),
    'A strip of "{0}" is being tweaked in the NLA editor, which holds its action. Leave the tweak mode there first '
    "(Tab).": (
        '"{0}"のストリップがNLAエディターで調整中のため、アクションが固定されています。先に調整モードを終了してくださ'
        "い(Tab)。"
    ),
    '"{0}" has no weights for the bones of an armature. Choose a rigged Source.': (
        '"{0}"にはアーマチュアのボーンのウェイトがありません。リグを持つソースを選んでください。'
    ),
    'The bones of "{0}" were changed. Pair the bones again.': (
        '"{0}"のボーンが変更されました。もう一度ボーンをペアにしてください。'
    ),
    'The vertex groups of all paired bones of "{0}" are locked on "{1}", or the bones do not deform. '
    "Unlock some of them.": (
        '"{0}"のペアになったボーンの頂点グループがすべて"{1}"でロックされているか、ボーンが変形しません。いくつか'
        "のロックを解除してください。"
    ),
    "Transferring rotations": "回転を移しています",
    "Posing the bones": "ボーンにポーズを付けています",
    "Keeping the feet": "足を保っています",
    "Keeping the hands": "手を保っています",
    'Paired "{0}" with "{1}"': '"{0}"を"{1}"とペアにしました',
    '"{0}" stays alone': '"{0}"は単独のままです',
    '"{0}" was taken out of the table': '"{0}"を表から取り除きました',
    "{0} pairs were taken out of the table": "{0}組のペアを表から取り除きました",
    'The pairs of bones were saved to "{0}"': 'ボーンのペアを"{0}"に保存しました',
    "{0} pairs were loaded": "{0}組のペアを読み込みました",
    "{0} pairs were loaded. These bones are missing: {1}": "{0}組のペアを読み込みました。次のボーンがありません: {1}",
    'By their names, left bones of "{0}" are paired with right ones of "{1}". If that is wrong, one of '
    "them looks the other way, or the match is mirrored: use another answer of the match, and pair the bones again.": (
        '名前によると、"{0}"の左のボーンが"{1}"の右のボーンとペアになっています。それが誤りなら、一方が逆を向いて'
        "いるか、マッチングが左右反転しています。マッチングの別の解を使い、もう一度ボーンをペアにしてください。"
    ),
    "Symmetrise": "対称化",
    "Test Poses": "ポーズのテスト",
    (
        "Bend every joint of the target's rig in turn, with a marker for each on the timeline; pressed "
        "again, all of it is taken away"
    ): (
        "ターゲットのリグの関節を一つずつ順に曲げます。タイムラインにそれぞれのマーカーが付きます。もう一度押"
        "すと、すべて取り除かれます"
    ),
    (
        "Name of the mesh or armature; if empty, the one picked in the panel, that of the last retarget, or "
        "else the active object"
    ): (
        "メッシュまたはアーマチュアの名前。空の場合は、パネルで選んだもの、最後のリターゲットのもの、またはア"
        "クティブオブジェクト"
    ),
    "Remove": "取り除く",
    "Take test poses away, and make none if there are none": "テスト用のポーズを取り除きます。なければ何も作りません",
    'The test poses of "{0}" are gone': "「{0}」のテスト用ポーズを取り除きました",
    'No bone of "{0}" moves a mesh. Transfer the weights first.': (
        "「{0}」にはメッシュを動かすボーンがありません。先にウェイトを転送してください。"
    ),
    '"{0}" bends {1} in {2} frames. Space plays it, the button ends it': (
        "「{0}」は{1}を{2}フレームで曲げます。スペースキーで再生し、ボタンで終わります"
    ),
    "Before and After": "前と後",
    (
        "Show the target as it stood before it got rig, shape keys and clothes; pressed again, as it is "
        "now, with the pose that it was in"
    ): ("リグ、シェイプキー、衣服を受け取る前のターゲットを表示します。もう一度押すと、今の状態とポーズに戻ります"),
    (
        "Name of the mesh; if empty, the one picked in the panel, that of the last retarget, or else the active object"
    ): "メッシュの名前。空の場合は、パネルで選んだもの、最後のリターゲットのもの、またはアクティブオブジェクト",
    '"{0}" is shown as it is': "「{0}」を今の状態で表示しています",
    '"{0}" is shown as it was before': "「{0}」を元の状態で表示しています",
    (
        '"{0}" has no rig, shape keys or clothes that came from a source, so it is as it was before.'
    ): "「{0}」にはソースから来たリグ、シェイプキー、衣服がないので、元のままです。",
    "It is open which character is meant. Pick it as the Target, or make it the active object.": (
        "どのキャラクターかが決まっていません。ターゲットに選ぶか、アクティブオブジェクトにしてください。"
    ),
    '"{0}" has no armature that could bend it. Retarget it with Rig on first.': (
        "「{0}」には曲げるためのアーマチュアがありません。先に「リグ」をオンにしてリターゲットしてください。"
    ),
    '"{0}" is linked from another file and cannot be posed. Make it local first.': (
        "「{0}」は他のファイルからリンクされており、ポーズを付けられません。先にローカル化してください。"
    ),
    (
        "Take weights, shape keys and colors of one side of a mesh to its other side, also if its pose or its "
        "topology is not symmetric"
    ): "ポーズやトポロジーが対称でなくても、メッシュの片側のウェイト、シェイプキー、色を反対側に写します",
    "Name of the object to make symmetric; if empty, the active object": (
        "対称にするオブジェクトの名前。空ならアクティブオブジェクト"
    ),
    "Symmetry": "対称",
    "Starting": "開始しています",
    "The Prefix is empty. Enter what the names of the vertex groups shall start with.": (
        "接頭辞が空です。頂点グループの名前の先頭に付ける文字列を入力してください。"
    ),
    "The Prefix is too long. Enter one of at most {0} letters, or {1} in Chinese or Japanese.": (
        "接頭辞が長すぎます。英数字で{0}文字まで、日本語や中国語で{1}文字までにしてください。"
    ),
    "This file of landmarks is of a newer version of HierMatch. Update the extension.": (
        "このランドマークのファイルは新しいバージョンのHierMatchのものです。エクステンションを更新してください。"
    ),
    "This is no file of landmarks, or it is damaged. Choose one that Save Landmarks has written.": (
        "これはランドマークのファイルではないか、破損しています。「ランドマークを保存」で書き出したファイルを選"
        "んでください。"
    ),
    "Prepared Shapes (MB)": ("準備済みの形状 (MB)"),
    "Memory for what is computed of a mesh alone, kept until Blender is closed, so that matching it "
    "again, or with another mesh, takes less time. With 0 nothing is kept": (
        "メッシュだけから計算される内容を保持するメモリ。Blenderを閉じるまで保持され、同じメッシュを再び、または別のメッシュとマッチングするときの時間を短縮します。0では何も保持しません"
    ),
    "Forget Prepared Shapes": ("準備済みの形状を破棄"),
    "Free the memory of the meshes that were matched in this session; matching one again prepares it anew": (
        "このセッションでマッチングしたメッシュのメモリを解放します。再びマッチングするときは改めて準備されます"
    ),
    "The prepared shapes were forgotten": ("準備済みの形状を破棄しました"),
    "The process that did the work ended before it was done, maybe for want of memory. Nothing was "
    "changed. Close other programs or use smaller meshes, and try again.": (
        "作業をしていたプロセスが、終わる前に終了しました。メモリ不足かもしれません。何も変更されていません。ほかのプログラムを閉じるか、より小さいメッシュを使い、もう一度お試しください。"
    ),
    "HierMatch is at work. Wait for it, or cancel it": "HierMatchが作業中です。待つか、キャンセルしてください",
    "Switch to Object Mode or to Edit Mode first": "先にオブジェクトモードまたは編集モードに切り替えてください",
    (
        "It is open which vertices correspond. Select one vertex on each mesh in Edit Mode, or two empties near "
        "the surfaces in Object Mode, or click on them with Pick Landmarks."
    ): (
        "どの頂点が対応するのかが決まりません。編集モードで各メッシュの頂点を一つずつ選択するか、オブジェクトモ"
        "ードで表面の近くの二つのエンプティを選択するか、「ランドマークを指定」でクリックしてください。"
    ),
    "The file holds the symmetry of one mesh, not the match of two. Choose another file.": (
        "このファイルには二つのメッシュのマッチングではなく、一つのメッシュの対称性が入っています。別のファイル"
        "を選んでください。"
    ),
    "Nothing is running": "実行中のものはありません",
    "There is nothing here that HierMatch has written": "HierMatchが書き込んだものはここにはありません",
    "None of these objects carries anything that HierMatch has written.": (
        "これらのオブジェクトはどれもHierMatchが書き込んだものを持っていません。"
    ),
    "No landmark is chosen. Choose one in the list, or add one.": (
        "ランドマークが選ばれていません。リストから選ぶか、追加してください。"
    ),
    "There is no such matched point. Match Source and Target first, or choose a point in the list.": (
        "その対応点はありません。先にソースとターゲットをマッチングするか、リストからポイントを選んでください。"
    ),
    "There is no match to flip. Match two meshes first, or name one that carries a match.": (
        "切り替えるマッチングがありません。先に二つのメッシュをマッチングするか、マッチングを持つメッシュを指定"
        "してください。"
    ),
    "No file is named. Choose one.": "ファイルが指定されていません。選んでください。",
    "Two mesh objects are needed in this view layer": "このビューレイヤーに二つのメッシュオブジェクトが必要です",
    "Two mesh objects are needed in this view layer. Make library overrides of what instances show, or make it real": (
        "このビューレイヤーに二つのメッシュオブジェクトが必要です。インスタンスが示すものは、ライブラリオーバーライドにするか、実体化してください"
    ),
    "There is nothing to click on. Use hiermatch.add_landmark with two vertices.": (
        "クリックできるものがありません。二つの頂点を指定してhiermatch.add_landmarkを使ってください。"
    ),
    '"{0}" was edited since the click on it. Click on its place again.': (
        "「{0}」はクリックした後に編集されました。もう一度その場所をクリックしてください。"
    ),
    (
        'The match exchanges left and right between "{0}" and "{1}", and clothes and motion cannot be carried across '
        "it. Press Use Mirrored Match once more, or match again."
    ): (
        "このマッチングは「{0}」と「{1}」の左右を入れ替えているため、衣服とモーションは転写できません。"
        "「ミラーマッチングを使用」をもう一度押すか、マッチングし直してください。"
    ),
    (
        'That place of "{0}" is shown by its Mirror modifier. Click on the half that is a mesh, or apply the modifier '
        "first."
    ): (
        "「{0}」のその場所はミラーモディファイアーが表示しています。メッシュそのものである半分をクリックするか、"
        "先にモディファイアーを適用してください。"
    ),
    "One of the two meshes was deleted. Press Esc and start again.": (
        "二つのメッシュの一方が削除されました。Escを押してやり直してください。"
    ),
    (
        '"{0}" is linked from another file, so its matches cannot be shown or refined. Make object and data local '
        "first (Object > Relations > Make Local)."
    ): (
        "「{0}」は他のファイルからリンクされているため、そのマッチングは表示も改良もできません。先にオブジェクトと"
        "データをローカル化してください（オブジェクト > 関係 > ローカル化）。"
    ),
    "There is no match to refine. Pick two meshes as Source and Target, and match them.": (
        "改良するマッチングがありません。二つのメッシュをソースとターゲットに選び、マッチングしてください。"
    ),
    "A landmark is far from where the map had taken it. If the result is wrong, match again.": (
        "あるランドマークが、マップが示していた場所から遠く離れています。結果が誤っていたら、再マッチングしてください。"
    ),
    "There is no match to show. Pick two meshes as Source and Target, and match them.": (
        "表示するマッチングがありません。二つのメッシュをソースとターゲットに選び、マッチングしてください。"
    ),
    "Pick a Source or a Target first": "先にソースまたはターゲットを選んでください",
    "It is open which mesh is to be made symmetric. Make it the active object.": (
        "どのメッシュを対称にするのかが決まりません。アクティブオブジェクトにしてください。"
    ),
    "Leave Out": "除外",
    "Output": "出力",
    "Advanced": "詳細設定",
    "Of Source": "ソースから",
    "Of Target": "ターゲットから",
    "Write": "書込",
    "Pick two meshes, or select them: the active one is the source": (
        "二つのメッシュを指定するか、選択してください。アクティブな方がソースです"
    ),
    "Measuring the matched points": "対応点を計測しています",
    '{0} of the items were added to the rig of "{1}".': '"{1}"のリグに、アイテムの{0}を追加しました。',
    'The rig of "{0}" has other bones, so the weights were taken from its skin and from the bones that are paired '
    "with the items' own.": (
        '"{0}"のリグにはほかのボーンがあるため、ウェイトは肌と、アイテム自身のボーンとペアのボーンから取りました。'
    ),
    'The armature "{0}" is linked from another file, so bones of the items were not added to it. Make it '
    "local first.": (
        'アーマチュア"{0}"はほかのファイルからリンクされているため、アイテムのボーンは追加されませんでした。先にローカルにしてください。'
    ),
    "Follow Shape Keys": "シェイプキーに従う",
    "Give the fitted items the other body's shape keys that move it below them, driven by its own: they follow "
    "a wide belly or a squat": (
        "合わせたアイテムに、その下で相手のボディを動かすシェイプキーを与え、ボディのキーで駆動します。大きな腹やし"
        "ゃがみに付いていきます"
    ),
    "Following shape keys": "シェイプキーに従わせています",
    '"{0}" follows {1} of "{2}".': '"{0}"は"{2}"の{1}に従います。',
    '{0} of "{1}" could not be bound to "{2}". Bind it by hand.': (
        '"{1}"の{0}を"{2}"にバインドできませんでした。手動でバインドしてください。'
    ),
    '"{0}" was edited after it had been fitted. As it was then it is kept, hidden, as {1}.': (
        "「{0}」はフィット後に編集されていました。編集されたものは{1}として非表示で残してあります。"
    ),
    'What was painted on "{0}" in {1} changes nothing: paint it on "{2}".': (
        "「{0}」の{1}に描かれたものは効果がありません。「{2}」に描いてください。"
    ),
    '"{0}" is an armature, and items are meshes. Name those that it moves: {1}.': (
        '"{0}"はアーマチュアですが、アイテムはメッシュです。それが動かすメッシュの名前を挙げてください: {1}。'
    ),
    '"{0}" is an armature, and items are meshes. It moves none but a body: name others, or take it out.': (
        '"{0}"はアーマチュアですが、アイテムはメッシュです。体のほかには何も動かしていません: ほかのものを指定す'
        "るか、外してください。"
    ),
    'Drivers of "{0}" still read from {1}: "{2}" has not what they need. Carry its shape keys or bones over by '
    "Retarget, and fit it again.": (
        '"{0}"のドライバーはまだ{1}を参照しています。"{2}"に必要なものがありません。リターゲットでシェイ'
        "プキーやボーンを移してから、もう一度合わせてください。"
    ),
    'Modifiers of "{0}" still use {1}, as those of the original do. Put a copy of it where "{2}" is, and pick that.': (
        '"{0}"のモディファイアーは、元のものと同じく、まだ{1}を使っています。"{2}"のある所にその複製を置き、それを選んで'
        "ください。"
    ),
    "The collection of {0} is hidden or left out. Show it in the Outliner.": (
        "{0}のコレクションは非表示か除外されています。アウトライナーで表示してください。"
    ),
    "Mend in Poses": "ポーズで補正",
    "Bend each joint of the other body's rig, and where its skin pokes through an item then, bring the weights "
    "there closer to those of the skin, and lift the item a little": (
        "相手のボディのリグの各関節を曲げてみて、肌がアイテムを突き抜けるところでは、ウェイトを肌の"
        "ものに近づけ、アイテムを少し浮かせます"
    ),
    "Fit clothes, hair and accessories of the source, which are objects of their own, to the matched bodies. "
    "Without named items it takes the selected ones, or else, if the source is one mesh, all others that its "
    "armature moves": (
        "ソースの服・髪・アクセサリー（それぞれ独立したオブジェクト）を、マッチングしたボディに合わせます。アイテ"
        "ムの指定がなければ選択中のもの、それもなく、ソースが一つのメッシュなら、そのアーマチュアが動かすほかのすべて"
        "のものを使います"
    ),
    "Names of the objects to fit; if empty, those in the collection, or else the selected ones, or else, if the "
    "source is one mesh, all others that its armature moves": (
        "合わせるオブジェクトの名前。空の場合はコレクション内のもの、なければ選択中のもの、それもなく、ソースが"
        "一つのメッシュなら、そのアーマチュアが動かすほかのすべてのもの"
    ),
    "Their own, if the other body's rig has these bones, or else those of its skin": (
        "相手のボディのリグに同じボーンがあれば自身のウェイト、なければ肌のウェイト"
    ),
    "Those of the other body's skin, from where the items lie on it": (
        "アイテムが載っている場所の、相手のボディの肌のウェイト"
    ),
    '"{0}" has no armature, so what was fitted to it is not bound. Give it one by Retarget, and fit it again.': (
        '"{0}"にはアーマチュアがないため、合わせたものはバインドされていません。リターゲットでアーマチュアを与え'
        "てから、もう一度合わせてください。"
    ),
    '"{0}" is far from "{1}". Move it to where the body wears it, or pick that body as the Source.': (
        '"{0}"は"{1}"から遠く離れています。ボディが身に着ける位置に移動するか、そのボディをソースに選んでください。'
    ),
    '"{0}" is not a mesh but of type {1}. Convert a copy of it (Object > Convert > Mesh), and fit that.': (
        '"{0}"はメッシュではなく{1}タイプです。コピーを変換して（オブジェクト > 変換 > メッシュ）、それを合わせて'
        "ください。"
    ),
    '"{0}" is the body itself, picked as the {1}. Take it out of the items, or pick another body.': (
        '"{0}"は{1}に選ばれているボディそのものです。アイテムから外すか、別のボディを選んでください。'
    ),
    '"{0}" lies on "{1}", not on "{2}". Swap Source and Target, or take it out of the items.': (
        '"{0}"は"{2}"ではなく"{1}"の上にあります。ソースとターゲットを入れ替えるか、アイテムから外してください。'
    ),
    "A copy of each item, in a collection of its own": "各アイテムのコピーを専用のコレクションに作ります",
    "A shape key on each item that moves it to the other body": (
        "各アイテムに、相手のボディへ移すシェイプキーを作ります"
    ),
    "As It Is": "そのまま",
    "Body Below": "下のボディ",
    "Clearance": "すき間",
    "Close to the skin it follows each form of it, far from it only the body as a whole": (
        "肌の近くではその形に沿い、離れたところではボディ全体にだけ従います"
    ),
    "Collection": "コレクション",
    "Find Rigid Parts": "硬いパーツを探す",
    "Fit": "フィット",
    "Fitted Copies": "合わせたコピー",
    "Fitting clothes": "服を合わせています",
    "From the Skin": "肌から",
    "How many bones may move a vertex: the smallest weights go. 0 for any number": (
        "一つの頂点を動かせるボーンの数。小さいウェイトから除かれます。0なら無制限"
    ),
    "How the item follows the body": "アイテムがボディにどう従うか",
    "If the other body has no armature, give it that of the first, with its weights, as Retarget does, so that "
    "body and clothes move": (
        "相手のボディにアーマチュアがなければ、リターゲットと同じように元のアーマチュアとウェイトを与え、ボディと"
        "服が動くようにします"
    ),
    "It follows each form of the skin, such as tights or a second skin": "タイツのように、肌の形にぴったり沿います",
    "It gets a Mask modifier with a vertex group that hides it below clothes": (
        "服の下を隠す頂点グループを使ったマスクモディファイアーを付けます"
    ),
    "It gets a shape key that draws it in below clothes": "服の下を引っ込めるシェイプキーを付けます",
    "It is left as it is": "そのままにします",
    "It is moved along with the body, but not pushed out of it": "ボディと一緒に移動しますが、外へ押し出しません",
    "It keeps its own shape and hangs as it did, such as a coat or long hair": (
        "コートや長い髪のように、自身の形を保ち、元のように垂れます"
    ),
    "It keeps its shape wholly and only grows, such as a helmet": (
        "ヘルメットのように、形を完全に保ち大きさだけ変わります"
    ),
    "Items": "アイテム",
    "Keep small solid parts as they are, such as buttons, buckles and glasses. Others can be named by a vertex "
    'group called "Rigid"': (
        "ボタン、バックル、眼鏡などの小さく硬いパーツをそのままの形に保ちます。ほかのものは「Rigid」という頂点グ"
        "ループで指定できます"
    ),
    "Least distance from the skin. With 0 it is what the items had on their own body, in the size of the other": (
        "肌からの最小距離。0なら、元のボディでの距離を相手の大きさに合わせたもの"
    ),
    "Leave": "そのまま",
    "Let the weights of all bones sum to one at each vertex. Locked groups keep theirs": (
        "各頂点ですべてのボーンのウェイトの合計を1にします。ロックされたグループは変わりません"
    ),
    "Loose": "ゆったり",
    "Mask": "マスク",
    "Measuring": "測定中",
    "Moving items along": "アイテムを移動しています",
    "Moving the skin": "肌を移動しています",
    "Name of a collection whose meshes are fitted": "メッシュを合わせるコレクションの名前",
    'No clothes of "{0}" were found: all of its meshes count as its body. Select only those of them that are worn, '
    "with the other body, or name them.": (
        '"{0}"の服が見つかりません。そのメッシュはすべてボディとみなされます。着ているものだけをもう一方のボディと'
        "一緒に選択するか、名前を指定してください。"
    ),
    'No clothes of "{0}" were found: no other mesh is bound to its armature. Pick both bodies as Source and '
    "Target, and select the items, or name them.": (
        '"{0}"の服が見つかりません。アーマチュアにバインドされたほかのメッシュがありません。両方のボディをソースと'
        "ターゲットに指定してアイテムを選択するか、名前を指定してください。"
    ),
    "Own": "自身",
    "Pushing items out": "アイテムを外へ押し出しています",
    "Rigid": "硬い",
    "Show Fit": "フィットを表示",
    "Show in this viewport what Wear has written with Show Fit on": (
        "「フィットを表示」をオンにした「着せる」が書き込んだものを、このビューポートに表示します"
    ),
    "Distance to Skin": "肌からの距離",
    "Show how far clothes are from the skin, from white to dark red; blue is inside": (
        "衣服が肌からどれだけ離れているかを白から暗い赤で表示します。青は内側です"
    ),
    "Pushed": "押し出し",
    "Show how far clothes were pushed out of the skin, from white (not at all) to dark red": (
        "衣服が肌からどれだけ押し出されたかを、白（なし）から暗い赤で表示します"
    ),
    "Uncertain": "不確かさ",
    "Show where the fit is uncertain, from white (nowhere) to dark red": (
        "フィットが不確かなところを、白（なし）から暗い赤で表示します"
    ),
    "Nothing here carries the colors of a fit. Press Wear with Show Fit on.": (
        "フィットのカラーを持つものがありません。「フィットを表示」をオンにして「着せる」を押してください。"
    ),
    "Shrink Key": "縮小キー",
    'The armature "{0}" has no bones {1} of "{2}". What they moved is moved by the bones of the skin below.': (
        'アーマチュア"{0}"には"{2}"のボーン{1}がありません。それらが動かしていた部分は、下の肌のボーンで動きます。'
    ),
    'The collection "{0}" has no meshes that could be fitted.': (
        'コレクション"{0}"には合わせられるメッシュがありません。'
    ),
    "Their own, whatever bones the other body has": "相手のボディのボーンにかかわらず、自身のウェイト",
    'There is no body under most of "{0}": "{1}" has no surface there. Pick the whole body as the Source, or '
    "take the item out.": (
        '"{0}"の大部分の下にボディがありません。"{1}"はそこに面がありません。ボディ全体をソースに選ぶか、アイテム'
        "を外してください。"
    ),
    'There is no collection called "{0}".': '"{0}"というコレクションはありません。',
    "Tight": "ぴったり",
    "Trying poses": "ポーズを試しています",
    "Wear": "着せる",
    "What becomes of the body where clothes cover it": "服に覆われた部分のボディをどうするか",
    "Which weights the fitted items get": "合わせたアイテムが得るウェイト",
    "Write color attributes that show how far each vertex is from the skin, how far it was pushed, and where "
    "it is uncertain": ("各頂点の肌からの距離、押し出された量、不確かなところを示すカラー属性を書き込みます"),
    '"{0}" was fitted.': '"{0}"を合わせました。',
    '"{0}" was fitted: {1}.': '"{0}"を合わせました: {1}。',
    '"{0}" should be checked: {1}.': '"{0}"を確認してください: {1}。',
    "kept the shape of {0}": "{0}の形を保持",
    "pushed {0} of it out of what is below": "{0}を下のものの外へ押し出し",
    "laid onto the skin of the other body": "相手の体の肌の上に配置",
    "what is below still shows through {0} of it": "下のものがまだ{0}で突き抜けています",
    "the match is uncertain below {0} of it": "その{0}の下でマッチングが不確かです",
    "the body ends below {0} of it": "その{0}の下には体がありません",
    '"{0}" counts as part of the body as well: "{1}" has no skin below it.': (
        '"{1}"には"{0}"の下に肌がないので、"{0}"も体の一部とみなします。'
    ),
    'Weights of {0} of "{1}" were mended for poses.': 'ポーズのために"{1}"の{0}のウェイトを直しました。',
    '{0} of "{1}" were lifted off the skin for poses.': 'ポーズのために"{1}"の{0}を肌から浮かせました。',
    "1 item": "1個のアイテム",
    "{0} items": "{0}個のアイテム",
    "{0} more": "ほか{0}個",
    "Select the clothes of the source, or bind them to its armature.": (
        "ソースの服を選択するか、そのアーマチュアにバインドしてください。"
    ),
    "1 rigid part": "1個の硬いパーツ",
    "{0} rigid parts": "{0}個の硬いパーツ",
    "Clothes": "服",
    'The rig of "{0}" has other bones, so the weights were taken from its skin.': (
        '"{0}"のリグにはほかのボーンがあるため、ウェイトは肌から取りました。'
    ),
    "Wrap and Morph": "ラップとモーフ",
    "Switch to Object Mode first": "先にオブジェクトモードに切り替えてください",
    "Mirror": "ミラー",
    "Pick Source and Target first": "先にソースとターゲットを選んでください",
    "There is no match yet": "マッチングはまだありません",
    "Which mesh is the Source is open: pick it in the panel, or make it the active object.": (
        "どのメッシュがソースなのかが決まりません。パネルで選ぶか、アクティブオブジェクトにしてください。"
    ),
    (
        'The collection "{0}" holds no mesh with faces that is shown in this view layer. Show its meshes, or choose '
        "another one."
    ): (
        "コレクション「{0}」には、このビューレイヤーに表示されている面のあるメッシュがありません。メッシュを表示するか、"
        "別のコレクションを選んでください。"
    ),
    (
        'The armature "{0}" moves no mesh with faces that is shown in this view layer. Show its meshes, or choose '
        "another one."
    ): (
        "アーマチュア「{0}」は、このビューレイヤーに表示されている面のあるメッシュを動かしていません。メッシュを表示するか、"
        "別のアーマチュアを選んでください。"
    ),
    '"{0}" belongs to both Source and Target. Choose two characters that share no object.': (
        "「{0}」はソースとターゲットの両方に属しています。同じオブジェクトを共有しない二つのキャラクターを選んでください。"
    ),
    (
        'All that is selected is moved by the same rig as "{0}": {1}. Select a mesh of another character, or pick the '
        "part as the Target in the panel if it is meant."
    ): (
        "選択されているものは、すべて「{0}」と同じリグで動いています：{1}。別のキャラクターのメッシュを選択するか、"
        "その部分を対象にするならパネルでターゲットに選んでください。"
    ),
    'What the rig of "{0}" moves as well was left alone: {1}.': (
        "「{0}」と同じリグで動くものは変更していません：{1}。"
    ),
    "It is open which mesh is the Target. Pick it in the panel, or select one or more beside the Source.": (
        "どのメッシュがターゲットなのかが決まりません。パネルで選ぶか、ソースのほかに一つ以上選択してください。"
    ),
    "All kinds are switched off, so there is nothing to carry over. Switch on at least one: Rig, Weights, Shape Keys, "
    "UV Maps or Attributes.": (
        "すべての種類がオフなので、転送するものがありません。リグ、ウェイト、シェイプキー、UVマップ、属性のうち少なくとも一つを"
        "オンにしてください。"
    ),
    "Finding faces": "面を探しています",
    "Carrying materials and normals": "マテリアルと法線を転送しています",
    "The rig of the source was changed meanwhile. Nothing was written.": (
        "その間にソースのリグが変更されました。何も書き込まれていません。"
    ),
    "Placing the joints": "関節を配置しています",
    "Finding the rest pose": "レストポーズを求めています",
    "No shape key is named. Enter the Names of some, separated by commas.": (
        "シェイプキーの名前がありません。「名前」にコンマで区切って入力してください。"
    ),
    "Telling the sides apart": "左右を区別しています",
    "Mirroring": "ミラーしています",
    "No UV map is named. Enter the Names of some, separated by commas.": (
        "UVマップの名前がありません。「名前」にコンマで区切って入力してください。"
    ),
    "Finding shapes in between": "中間の形状を求めています",
    "The attributes of the stored map hold numbers that no match has written. Match again.": (
        "保存されたマップの属性に、マッチングが書き込んだものではない数値があります。再マッチングしてください。"
    ),
    "The stored map is one of meshes with other vertices. Match again.": (
        "保存されたマップは頂点の異なるメッシュのものです。再マッチングしてください。"
    ),
    "No matching is possible: too many pairs of a point and a candidate are forbidden.": (
        "マッチングできません。ポイントと候補の組が多く禁止されすぎています。"
    ),
    "No triangle of the mesh has three different corners. Check its scale and its vertices.": (
        "三つの角がすべて異なる三角形がメッシュにありません。スケールと頂点を確認してください。"
    ),
    "Nothing of the mesh has an area once repeated and degenerate faces are left out.": (
        "重複した面や縮退した面を除くと、メッシュに面積がなくなります。"
    ),
    "A search along the surface starts at a vertex without a triangle. Delete loose vertices.": (
        "表面に沿った探索が、三角形のない頂点から始まっています。孤立した頂点を削除してください。"
    ),
    "Some values at the corners of faces are not finite numbers. Repair them, or leave them out.": (
        "面コーナーの一部の値が有限の数ではありません。修復するか、除外してください。"
    ),
    "Measuring distances": "距離を計測しています",
    "Judging the map": "マップを評価しています",
    "Mapping every vertex": "すべての頂点をマップしています",
    "Bounding the best matching": "最良のマッチングの限界を求めています",
    "Tracing edges": "辺をたどっています",
    "Computing eigenfunctions": "固有関数を計算しています",
    "The faces use vertices that the map does not know. Match again.": (
        "マップにない頂点を面が使っています。再マッチングしてください。"
    ),
    "Refining maps": "マップを改良しています",
    "Comparing maps": "マップを比較しています",
    "Placing the first points": "最初のポイントを配置しています",
    "Comparing matchings": "マッチングを比較しています",
    "No bone of the rig moves a vertex.": "リグのどのボーンも頂点を動かしません。",
    "The mesh has no vertices.": "メッシュに頂点がありません。",
    "The mesh has no faces. A surface is needed, not only vertices or edges.": (
        "メッシュに面がありません。頂点や辺だけでなく、表面が必要です。"
    ),
    (
        "Every triangle of the mesh has zero area: the mesh has no surface. Check its scale and whether its "
        "vertices all lie on one line or in one point."
    ): (
        "メッシュのすべての三角形の面積が0で、表面がありません。スケールと、頂点がすべて一直線上または一点にな"
        "いかを確認してください。"
    ),
    "The faces of the mesh are not those that the map was made for. Match again.": (
        "メッシュの面が、マップを作ったときの面と異なります。再マッチングしてください。"
    ),
    "A face has fewer than three corners. Repair the mesh.": (
        "角が三つ未満の面があります。メッシュを修復してください。"
    ),
    "Cleaning": "クリーンアップしています",
    (
        "Some points do not lie on the main part of the mesh, which is the one that is matched. Choose points "
        "on that part."
    ): (
        "一部のポイントが、マッチングの対象であるメッシュの主要な部分にありません。その部分のポイントを選んでください。"
    ),
    "Landmark {number}": "ランドマーク {number}",
    "Point {number}, distortion {distortion}": "ポイント {number}、歪み {distortion}",
    "Preparing what is written": "書き込む内容を準備しています",
    "Cutting parts open that touch": "接した部分を切り開いています",
    "Simplifying the mesh": "メッシュを単純化しています",
    "There are no landmarks to refine the map around. Name at least one pair of vertices.": (
        "マップを改良するためのランドマークがありません。少なくとも一組の頂点を指定してください。"
    ),
    "Fitting the surfaces": "表面を合わせています",
    "The match exchanges left and right, and would turn clothes inside out. Use another answer of the match, "
    "or match the bodies again.": (
        "マッチングは左右を入れ替えており、服が裏返しになります。マッチングの別の解を使うか、もう一度マッチングしてください。"
    ),
    "The match exchanges left and right, so bones would turn the wrong way. Use another answer of the match, "
    "or match the bodies again.": (
        "マッチングは左右を入れ替えており、ボーンが逆向きに回転します。マッチングの別の解を使うか、もう一度マッチングして"
        "ください。"
    ),
    "No bone moves the main part of the source. Give it weights, or choose another source.": (
        "ソースの主要な部分を動かすボーンがありません。ウェイトを与えるか、別のソースを選んでください。"
    ),
    "Fitting the bones": "ボーンを合わせています",
    "The weights of the bones should be finite numbers that are not negative.": (
        "ボーンのウェイトは、負でない有限の数でなければなりません。"
    ),
    "Posing hands": "手のポーズを合わせています",
    "Sliding": "滑らせています",
    "Moving points over the surface": "ポイントを表面上で動かしています",
    "Finding regions without confidence": "信頼度のない領域を探しています",
    "A shape key of the source moves a vertex by what is not a finite number. Repair that key.": (
        "ソースのシェイプキーの一つが、有限の数でない量だけ頂点を動かしています。そのキーを修復してください。"
    ),
    "Carrying offsets": "オフセットを転送しています",
    "The skeleton has a joint whose position is not a finite number.": "骨格に、位置が有限の数でない関節があります。",
    "Some bones of the skeleton are their own ancestors.": "骨格の一部のボーンが自分自身の祖先になっています。",
    (
        "Nothing tells the two sides apart. Give the vertex groups names that end in .L and .R, or move the "
        "object's origin so that its X axis points to the left side."
    ): (
        "左右を区別する手がかりがありません。頂点グループに.Lと.Rで終わる名前を付けるか、X軸が左側を指すように"
        "オブジェクトの原点を動かしてください。"
    ),
    "The mesh is too coarse to be matched to anything but itself: use more Coarse Candidates or subdivide it.": (
        "メッシュが粗すぎて、自分自身以外にマッチングできません。「粗い候補」を増やすか、細分化してください。"
    ),
    "Placing the points": "ポイントを配置しています",
    "Cutting islands": "アイランドを切り出しています",
    "Laying faces onto islands": "面をアイランドに配置しています",
    "Carrying weights": "ウェイトを転送しています",
    "Joining pieces": "ピースをつないでいます",
    "Looking for missing parts": "足りない部分を探しています",
    "Looking for torn vertices": "引き離された頂点を探しています",
    "Filling in weights": "ウェイトを補充しています",
    "The map does not hold the source anywhere on the target: the two are too different. Match them again.": (
        "マップはターゲットのどこにもソースを留められません。両者が違いすぎます。再マッチングしてください。"
    ),
    "Placing parts that the target lacks": "ターゲットにない部分を配置しています",
    "Laying the surface onto the other": "表面をもう一方に重ねています",
    "Coarse Match": "粗いマッチング",
    "Left and Right": "左右",
    "Time": "時間",
    "none": "なし",
    "kept": "保持",
    "finished": "完了",
    "ended early, at most {gap} from the best": "途中で終了。最良との差は最大{gap}",
    "unclear, see colors": "不明。色を見て確かめてください",
    "good": "良好",
    "fair": "まずまず",
    "look closely": "よく確かめてください",
    "do not trust it": "信頼できません",
    "little": "わずか",
    "some": "いくらか",
    "much, the builds differ": "大きい。体型が異なります",
    "very much": "非常に大きい",
    "Search": "探索",
    "Details": "詳細",
    "Options": "オプション",
    "Demo and Files": "デモとファイル",
    "How distances are measured, and by what a place is recognised in another pose": (
        "距離の測り方と、別のポーズで場所を見分ける手がかり"
    ),
    "The first step: a few points, for which all combinations are looked through": (
        "最初の段階：少数の点について、すべての組み合わせを調べます"
    ),
    "The steps after: more points, each sought near where those around it lie": (
        "次の段階：点を増やし、それぞれを周りの点の近くで探します"
    ),
    "exchanged": "入れ替わり",
    "{count} points matched": "{count}個のポイントをマッチングしました",
    "Custom": "カスタム",
    "Metric and Descriptor": "距離と記述子",
    "Refinement": "改良",
    "The match was cancelled. Nothing was written": "マッチングはキャンセルされました。何も書き込まれていません",
    "It was cancelled. Nothing was written": "キャンセルされました。何も書き込まれていません",
    "It was cancelled. The match is as it was": "キャンセルされました。マッチングは元のままです",
    "It was cancelled. No landmark was added": "キャンセルされました。ランドマークは追加されていません",
    "There is no alternative {0}, only {1}: the direct answer was written.": (
        "代替解{0}はありません({1}個だけです)。直接の解を書き込みました。"
    ),
    "The map turns large parts of the surface over: do not trust it; try landmarks.": (
        "マップが表面の大きな部分を裏返しています。信頼せず、ランドマークを試してください。"
    ),
    "The shapes have little in common: limbs were taken for the same that both rigs have in the same places.": (
        "形状の共通点がわずかです: 両方のリグが同じ位置に持つ手足などを対応するものとみなしました。"
    ),
    "The shapes have little in common: the ends of their limbs were taken for the same where both stand alike.": (
        "形状の共通点がわずかです: 両方が同じように立っているので、手足などの先端を対応するものとみなしました。"
    ),
    "The shapes have too little in common: leave out what only one of them has, or try landmarks.": (
        "形状の共通点が少なすぎます。片方にしかない部分を除外するか、ランドマークを試してください。"
    ),
    "{0} maps are about as likely: choose another answer if this one is wrong, or add a landmark.": (
        "{0}個のマップが同じくらい有力です。これが誤っていれば別の解を選ぶか、ランドマークを追加してください。"
    ),
    "{0} maps are about as likely by their shape, and this one leaves all in place: check it.": (
        "形状だけなら{0}個のマップが同じくらい有力で、このマップはすべてを元の位置に保ちます。確認してください。"
    ),
    "Another map was almost as likely: check the sides and each limb, and add a landmark if one is wrong.": (
        "別のマップもほぼ同じくらい有力でした。左右と手足を確認し、誤っていればランドマークを追加してください。"
    ),
    "The shapes differ much: the map is a good guess that keeps left and right, but details may slide.": (
        "形状が大きく異なります。マップは左右を保ったよい推測ですが、細部はずれているかもしれません。"
    ),
    "The shapes correspond, with some stretching where they differ.": (
        "形状は対応しています。異なる部分では多少の伸縮があります。"
    ),
    "The shapes correspond closely.": "形状はよく対応しています。",
    "HierMatch Presets": "HierMatchプリセット",
    "Add HierMatch Preset": "HierMatchプリセットを追加",
    "Save the options of Match and Retarget as a preset, or remove one that was saved": (
        "「マッチング」と「リターゲット」のオプションをプリセットとして保存するか、保存したものを削除します"
    ),
    "Name": "名前",
    "Name of the preset, of which its file is named": "プリセットの名前。ファイル名にもなります",
    "Remove by Name": "名前で削除",
    "Remove the preset of that name instead of saving one": "保存する代わりに、その名前のプリセットを削除します",
    "Remove Active": "アクティブを削除",
    "Remove the preset that was chosen last instead of saving one": (
        "保存する代わりに、最後に選んだプリセットを削除します"
    ),
    "Check Existing": "上書きチェック",
    "Fast Preview": "高速プレビュー",
    "Two-Legged Characters": "二足キャラクター",
    "Creatures": "クリーチャー",
    "Scans": "スキャン",
    "{0}: {1}, {2}    Esc: cancel": "{0}：{1}、{2}    Esc：キャンセル",
    "Matching": "マッチング中",
    "Refining": "改良中",
    "Retargeting": "リターゲット中",
    "Symmetrising": "対称化中",
    "Carrying over": "引き継ぎ中",
    "Mirroring landmarks": "ランドマークを反転中",
    "Writing another answer": "別の解を書き込み中",
    "Exact search, {0} nodes": "厳密探索、{0}ノード",
    "Matching {0} points": "{0}個のポイントをマッチング中",
    "Moving {0} points over the surface": "{0}個のポイントを表面上で移動中",
    "{0}    Landmarks added: {1}    Enter: done    Esc: back": (
        "{0}    追加したランドマーク：{1}    Enter：完了    Esc：戻る"
    ),
    'Click on a place of "{0}" or "{1}"': "「{0}」か「{1}」の場所をクリック",
    'Click on the corresponding place of "{0}"': "「{0}」の対応する場所をクリック",
    "The shapes correspond, but for a small part of the target ({0}) that the other lacks.": (
        "形状は対応していますが、ターゲットの小さな一部（{0}）がソースにありません。"
    ),
    "The shapes correspond, but for a small part of the source ({0}) that the other lacks.": (
        "形状は対応していますが、ソースの小さな一部（{0}）がターゲットにありません。"
    ),
    "Only {0} of the target is reached: {1}": "ターゲットの{0}にしか届いていません。{1}",
    "The shapes overlap: {0} of the source and {1} of the target have a partner.": (
        "形状は一部で重なっています。ソースの{0}とターゲットの{1}に対応する場所があります。"
    ),
    "It is not clear what the shapes share: do not trust the map; add landmarks, or cut them alike.": (
        "形状のどこが共通なのかはっきりしません。このマップは信頼せず、ランドマークを追加するか、同じように切り取ってください。"
    ),
    "Only {0} of the source has a partner: {1}": "ソースの{0}にしか対応する場所がありません。{1}",
    "Separate pieces, {0} of a mesh, have no counterpart on the other: check where they went.": (
        "メッシュの{0}を占める独立したパーツに、もう一方のメッシュで対応するパーツがありません。行き先を確認してください。"
    ),
    "parts of one shape seem to be missing on the other.": "一方の形状の一部がもう一方にないようです。",
    "The {0} hangs together where the {1} does not: it was cut open there for matching.": (
        "{0}には{1}にないつながりがあるため、マッチングのためにそこを切り開きました。"
    ),
    "Matched {0} points of {1} in {2} s": "{1}の{0}個のポイントを{2}秒でマッチングしました",
    "Matched {0} points of {1} in {2} s. {3}": "{1}の{0}個のポイントを{2}秒でマッチングしました。{3}",
    '"{0}" and "{1}"': "「{0}」と「{1}」",
    "Refined the match in {0} s. {1}": "マッチングを{0}秒で改良しました。{1}",
    'Wrote the {0} match of "{1}" and "{2}"': "「{1}」と「{2}」の{0}マッチングを書き込みました",
    "direct": "直接の",
    "mirrored": "ミラー",
    "turned {0}": "回転{0}の",
    "Wrote {0} regions on both meshes as vertex groups": "両メッシュに{0}個の領域を頂点グループとして書き込みました",
    'Exported the match of "{0}" and "{1}" to "{2}"': "「{0}」と「{1}」の対応を「{2}」に書き出しました",
    'Imported the match of "{0}" and "{1}" from "{2}"': "「{0}」と「{1}」の対応を「{2}」から読み込みました",
    '"{0}" is hardly symmetric, so that its mirror images are uncertain (confidence {1}): check what was mirrored.': (
        "「{0}」はほとんど左右対称ではないため、鏡像の位置は不確かです（信頼度{1}）。ミラーした結果を確認してください。"
    ),
    "Nothing to mirror: all landmarks lie in the middle, or have one on the other side already": (
        "ミラーするものがありません。すべてのランドマークは中央にあるか、反対側にすでにあります"
    ),
    "Added {0} on the other side": "反対側に{0}を追加しました",
    "Cleared {0}": "{0}をクリアしました",
    "Setup: {0}": "設定：{0}",
    'Made "{0}" symmetric in {1} s: {2}': "「{0}」を{1}秒で対称にしました：{2}",
    'Carried to "{0}" in {1} s: {2}': "「{0}」に{1}秒で引き継ぎました：{2}",
    'Found for "{0}" in {1} s: {2}': "「{0}」について{1}秒で見つけました：{2}",
    'There is no object called "{0}".': "「{0}」という名前のオブジェクトはありません。",
    (
        "It is open which mesh is the {0}: {1}. Select exactly two meshes (the active one is the Source), or "
        "pick Source and Target in the panel."
    ): (
        "どのメッシュが{0}か決まりません（{1}）。メッシュをちょうど二つ選択するか（アクティブな方がソース）、"
        "パネルでソースとターゲットを選んでください。"
    ),
    "no other mesh is selected": "ほかのメッシュが選択されていません",
    "{0} other meshes are selected": "ほかに{0}個のメッシュが選択されています",
    'Source and Target are both "{0}". Choose two different objects.': (
        "ソースとターゲットがどちらも「{0}」です。別々のオブジェクトを選んでください。"
    ),
    (
        '"{0}" and "{1}" share the same mesh data. Give one of them its own first (Object > Relations > Make '
        "Single User > Object & Data)."
    ): (
        "「{0}」と「{1}」は同じメッシュデータを共有しています。先に一方を独立させてください（オブジェクト > "
        "関係 > シングルユーザー化 > オブジェクトとデータ）。"
    ),
    (
        '"{0}" is no mesh but shows the collection "{1}". Make its objects editable (Object > Library Override > Make, '
        "or Object > Apply > Make Instances Real), and choose one of them."
    ): (
        "「{0}」はメッシュではなく、コレクション「{1}」を表示しているものです。その中のオブジェクトを編集可能に"
        "して（オブジェクト > ライブラリオーバーライド > 作成、または オブジェクト > 適用 > インスタンスを実体化）、"
        "そのうちの一つを選んでください。"
    ),
    '"{0}" is not a mesh but of type {1}. Choose a mesh object, or convert it (Object > Convert > Mesh).': (
        "「{0}」はメッシュではなく{1}タイプです。メッシュオブジェクトを選ぶか、変換してください（オブジェクト"
        " > 変換 > メッシュ）。"
    ),
    '"{0}" is in no scene any more.': "「{0}」はもうどのシーンにもありません。",
    '"{0}" is not in the view layer "{1}". Link it to the scene, or enable its collection in the Outliner.': (
        "「{0}」はビューレイヤー「{1}」にありません。シーンにリンクするか、アウトライナーでコレクションを有効"
        "にしてください。"
    ),
    '"{0}" is hidden. Show it first (Object > Show/Hide, or the eye in the Outliner).': (
        "「{0}」は非表示です。先に表示してください（オブジェクト > 表示/隠す、またはアウトライナーの目のアイコン）。"
    ),
    '"{0}" is not shown: its collection is hidden or disabled in viewports, or it is outside of Local View. Show its '
    "collection in the Outliner, or leave Local View (View > Local View).": (
        "「{0}」は表示されていません。コレクションが非表示またはビューポートで無効か、ローカルビューの外にあります。"
        "アウトライナーでコレクションを表示するか、ローカルビューを終了してください（ビュー > ローカルビュー）。"
    ),
    '"{0}" is disabled in viewports. Enable it with the screen beside its name in the Outliner.': (
        "「{0}」はビューポートで無効になっています。アウトライナーで名前の横にある画面アイコンを押して有効に"
        "してください。"
    ),
    '"{0}" is in {1} Mode. Switch to Object Mode first.': (
        "「{0}」は{1}モードです。先にオブジェクトモードに切り替えてください。"
    ),
    '"{0}" shares its mesh with an object in Edit Mode. Switch to Object Mode there first.': (
        "「{0}」は編集モードのオブジェクトとメッシュを共有しています。先にそちらをオブジェクトモードに切り替えてください。"
    ),
    '"{0}" has no faces. A surface is needed, not only vertices or edges.': (
        "「{0}」には面がありません。頂点や辺だけでなく、面が必要です。"
    ),
    '"{0}" has a scale of zero on {1}. Set its scale to 1 (Alt+S).': (
        "「{0}」の{1}のスケールが0です。スケールを1にしてください（Alt+S）。"
    ),
    (
        '"{0}" is linked from "{1}" and cannot be written to. Make object and data local first (Object > '
        "Relations > Make Local). As the Source of Retarget, Wear and Motion it can stay as it is."
    ): (
        "「{0}」は「{1}」からリンクされており、書き込めません。先にオブジェクトとデータをローカル化してくださ"
        "い（オブジェクト > 関係 > ローカル化）。リターゲット、着せる、モーションのソースとしてはそのままで使え"
        "ます。"
    ),
    (
        '"{0}" is a library override and cannot be written to. Make object and data local first (Object > '
        "Relations > Make Local). As the Source of Retarget, Wear and Motion it can stay as it is."
    ): (
        "「{0}」はライブラリオーバーライドで、書き込めません。先にオブジェクトとデータをローカル化してくださ"
        "い（オブジェクト > 関係 > ローカル化）。リターゲット、着せる、モーションのソースとしてはそのままで使え"
        "ます。"
    ),
    (
        '"{0}" has no surface: each of its faces uses a vertex twice. Repair the mesh (in Edit Mode: Mesh > '
        "Clean Up > Degenerate Dissolve)."
    ): (
        "「{0}」には表面がありません。どの面も同じ頂点を二度使っています。メッシュを修復してください（編集モ"
        "ード：メッシュ > クリーンアップ > 縮退の溶解）。"
    ),
    (
        'The modifiers of "{0}" change its vertices from {1} to {2} ({3}). Apply or disable these modifiers, or '
        "turn Use Modifiers off."
    ): (
        "「{0}」のモディファイアーが頂点数を{1}から{2}に変えています（{3}）。これらを適用または無効にするか、"
        "モディファイアーの使用をオフにしてください。"
    ),
    (
        "{0} of {1} vertices have a position that is not a finite number, vertex {2} first. Delete these "
        "vertices or repair them."
    ): (
        "{1}個の頂点のうち{0}個の位置が有限の数ではありません（最初は頂点{2}）。これらの頂点を削除または修復"
        "してください。"
    ),
    '"{0}" has {1} vertices, too few for {2} Points. Set Points to {3} or fewer, or subdivide the mesh.': (
        "「{0}」の頂点は{1}個で、ポイント{2}個には足りません。ポイントを{3}以下にするか、メッシュを細分化してください。"
    ),
    'The faces of "{0}" changed while it was being matched. Nothing was written.': (
        "マッチング中に「{0}」の面が変わりました。何も書き込んでいません。"
    ),
    "The match was ended, because the objects changed: {0}": (
        "オブジェクトが変わったため、マッチングを終了しました：{0}"
    ),
    '"{0}" got another number of vertices while it was being matched. Nothing was written.': (
        "マッチング中に「{0}」の頂点数が変わりました。何も書き込んでいません。"
    ),
    'The match is out of date: "{0}" was edited since ({1}). Match again.': (
        "マッチングが古くなっています。「{0}」がその後編集されました（{1}）。もう一度マッチングしてください。"
    ),
    "it has other vertices or faces": "頂点か面が異なります",
    "its vertices were moved": "頂点が動かされました",
    "it was mirrored": "ミラーされました",
    'The match is out of date: "{0}" was cleared or matched anew. Match again.': (
        "マッチングが古くなっています。「{0}」がクリアまたは再マッチングされました。もう一度マッチングしてください。"
    ),
    'The match is out of date: "{0}" was deleted.': ("マッチングが古くなっています。「{0}」が削除されました。"),
    '"{0}" carries no match. Match it first.': "「{0}」にはマッチングがありません。先にマッチングしてください。",
    '"{0}" carries no match with the Prefix "{1}". Match it first.': (
        "「{0}」には接頭辞「{1}」のマッチングがありません。先にマッチングしてください。"
    ),
    '"{0}" carries several matches. Name the Prefix of one of them: {1}.': (
        "「{0}」には複数のマッチングがあります。いずれかの接頭辞を指定してください：{1}。"
    ),
    'The {0} of this match, "{1}", was deleted, or renamed and cleared, or is not in the view layer "{2}". '
    "Bring it back, or match again.": (
        "このマッチングの{0}「{1}」は削除されたか、名前を変えてからクリアされたか、ビューレイヤー「{2}」に"
        "ありません。戻すか、もう一度マッチングしてください。"
    ),
    "Several objects are copies of the {0} of this match: {1}. Match the two again.": (
        "このマッチングの{0}のコピーが複数あります：{1}。二つをもう一度マッチングしてください。"
    ),
    '"{0}" does not carry this match any more, because it was cleared or matched anew. Match the two again.': (
        "「{0}」はクリアまたは再マッチングされたため、このマッチングを持っていません。二つをもう一度マッチン"
        "グしてください。"
    ),
    '"{0}" was deleted, cleared or matched anew meanwhile. Nothing was written.': (
        "その間に「{0}」が削除、クリア、または再マッチングされました。何も書き込んでいません。"
    ),
    '"{0}" was edited meanwhile. Nothing was written.': "その間に「{0}」が編集されました。何も書き込んでいません。",
    '"{0}" was deleted meanwhile. Nothing was written.': "その間に「{0}」が削除されました。何も書き込んでいません。",
    "source": "ソース",
    "target": "ターゲット",
    (
        '"{0}" has other vertices or faces than when it was matched, so the stored match does not fit it any '
        "more. Match again."
    ): (
        "「{0}」の頂点か面がマッチング時と異なるため、保存されたマッチングは合いません。もう一度マッチングし"
        "てください。"
    ),
    'The match of "{0}" and "{1}" has no mirrored answer and no other: the meshes are not symmetric enough for one.': (
        "「{0}」と「{1}」のマッチングにはミラー解も他の解もありません。メッシュが十分に対称ではないためです。"
    ),
    "Use Landmarks is off, so there is nothing to refine around. Turn it on under Options.": (
        "「ランドマークを使用」がオフなので、改良の基準がありません。「オプション」でオンにしてください。"
    ),
    'The match of "{0}" and "{1}" has the alternatives 1 to {2} only.': (
        "「{0}」と「{1}」のマッチングにある代替解は1から{2}までだけです。"
    ),
    "{0} have no landmarks that are on. Add some where the match is wrong, and lock points where it is right.": (
        "{0}にはオンのランドマークがありません。マッチングが誤っている所に追加し、正しい所のポイントをロック"
        "してください。"
    ),
    "The match of {0} has no dense map to refine. Match them again with Dense Map on.": (
        "{0}のマッチングには改良する密なマップがありません。密なマップをオンにしてもう一度マッチングしてください。"
    ),
    (
        '"{0}" carries no colors called "{1}". Match again with {2} on under Output, and for confidence with '
        "Dense Map on."
    ): (
        "「{0}」には「{1}」というカラーがありません。出力で{2}をオンにし、信頼度には密なマップもオンにして、"
        "もう一度マッチングしてください。"
    ),
    '"{0}" already has {1} called "{2}" that HierMatch did not write. Rename it.': (
        "「{0}」には、HierMatchが書き込んだものではない{1}「{2}」があります。名前を変えてください。"
    ),
    '"{0}" already has {1} called "{2}" that HierMatch did not write. Rename it, or choose another Prefix.': (
        "「{0}」には、HierMatchが書き込んだものではない{1}「{2}」があります。名前を変えるか、別の接頭辞を選ん"
        "でください。"
    ),
    (
        '"{0}" already has {1} called "{2}", which belongs to the match with the Prefix "{3}". Choose another '
        "Prefix, or clear that match."
    ): (
        "「{0}」の{1}「{2}」は接頭辞「{3}」のマッチングのものです。別の接頭辞を選ぶか、そのマッチングをクリア"
        "してください。"
    ),
    "a vertex group": "頂点グループ",
    "a custom property": "カスタムプロパティ",
    "an attribute": "属性",
    (
        '"{0}" has no vertex group, boolean attribute, material or face set called "{1}", which is to be left out. '
        "Choose another one, or empty the field."
    ): (
        "「{0}」には、除外する「{1}」という頂点グループ、ブーリアン属性、マテリアル、フェイスセットがありません。別のものを選"
        "ぶか、欄を空にしてください。"
    ),
    'No vertex of "{0}" is in "{1}", which is to be left out. Assign vertices to it, or empty the field.': (
        "除外する「{1}」に「{0}」の頂点がありません。頂点を割り当てるか、欄を空にしてください。"
    ),
    'All of "{0}" is in "{1}", which is to be left out, so nothing remains to match. Choose a smaller region.': (
        "「{0}」のすべてが除外する「{1}」に入っており、マッチングするものが残りません。もっと小さい領域を選ん"
        "でください。"
    ),
    "Nothing of the {0} is left to match: all of its faces are left out.": (
        "{0}にマッチングするものが残っていません。すべての面が除外されています。"
    ),
    '"{0}" and "{1}" have no landmarks in common that are on. Add some first.': (
        "「{0}」と「{1}」には共通のオンのランドマークがありません。先に追加してください。"
    ),
    '"{0}" and "{1}" have no landmarks in common. Add some first.': (
        "「{0}」と「{1}」には共通のランドマークがありません。先に追加してください。"
    ),
    '"{0}" and "{1}" have no landmark {2} in common.': "「{0}」と「{1}」には共通のランドマーク{2}がありません。",
    'Source and Target are both "{0}", or share the same mesh data. Choose two meshes of their own.': (
        "ソースとターゲットがどちらも「{0}」か、同じメッシュデータを共有しています。別々のメッシュを選んでください。"
    ),
    '"{0}" is not a mesh. Pick two mesh objects as Source and Target.': (
        "「{0}」はメッシュではありません。ソースとターゲットにメッシュオブジェクトを選んでください。"
    ),
    '"{0}" is in {1} Mode. Leave it first.': "「{0}」は{1}モードです。先にモードを抜けてください。",
    (
        'The modifiers of "{0}" show it far away from its own vertices. Disable them in the viewport, or select '
        "a vertex on each mesh in Edit Mode."
    ): (
        "「{0}」はモディファイアーにより自身の頂点から離れて表示されています。ビューポートで無効にするか、編"
        "集モードで各メッシュの頂点を選択してください。"
    ),
    '"{0}" is not in Edit Mode. Select both meshes, enter Edit Mode, and select one vertex on each.': (
        "「{0}」は編集モードではありません。両方のメッシュを選択して編集モードに入り、それぞれ頂点を一つ選択"
        "してください。"
    ),
    '{0} vertices of "{1}" are selected. Select exactly one vertex on each of the two meshes.': (
        "「{1}」の{0}個の頂点が選択されています。二つのメッシュでそれぞれちょうど一つの頂点を選択してください。"
    ),
    "A mesh can have {0} landmarks. Remove some first.": (
        "メッシュに置けるランドマークは{0}個までです。先にいくつか削除してください。"
    ),
    '"{0}" has no vertex {1}: its vertices are numbered from 0 to {2}.': (
        "「{0}」に頂点{1}はありません。頂点の番号は0から{2}です。"
    ),
    '"{0}" and "{1}" carry no match with one another.': "「{0}」と「{1}」の間にマッチングはありません。",
    'Click on "{0}" or on "{1}".': "「{0}」か「{1}」をクリックしてください。",
    'Landmark {0}: vertex {1} of "{2}" is vertex {3} of "{4}"': (
        "ランドマーク{0}：「{2}」の頂点{1}は「{4}」の頂点{3}です"
    ),
    "Removed landmark {0}": "ランドマーク{0}を削除しました",
    "{0} had that in common with {1} as well": "{0}と{1}にも共通していたランドマークです",
    "Locked {0} as landmark {1}": "{0}をランドマーク{1}としてロックしました",
    'Saved {0} to "{1}"': "{0}を「{1}」に保存しました",
    'Loaded {0} from "{1}"': "{0}を「{1}」から読み込みました",
    (
        '"{0}" has other vertices or faces than when the landmarks were saved. They were put on the vertices '
        "where they had been."
    ): "「{0}」の頂点か面がランドマークの保存時と異なります。ランドマークは元の位置の頂点に置きました。",
    (
        '"{0}" has no vertex of its own where landmark {1} of the file was. The file was saved for another mesh. '
        "Choose the right Source and Target."
    ): (
        "「{0}」には、ファイルのランドマーク{1}の位置に固有の頂点がありません。別のメッシュ用のファイルです。"
        "正しいソースとターゲットを選んでください。"
    ),
    "{0} landmarks are more than the {1} points that are matched. Use more points or fewer landmarks.": (
        "ランドマーク{0}個は、マッチングする{1}個のポイントより多すぎます。ポイントを増やすか、ランドマークを"
        "減らしてください。"
    ),
    "Landmarks {0} and {1} are both at vertex {2} of the {3}. Use a vertex for one landmark only.": (
        "ランドマーク{0}と{1}が{3}の同じ頂点{2}にあります。一つの頂点にはランドマークを一つだけ置いてください。"
    ),
    (
        "Landmark {0} is at vertex {1} of the {2}, which is not on its main part, the one that is matched. Choose "
        "a vertex on that part that is not left out."
    ): (
        "ランドマーク{0}は{2}の頂点{1}にあり、マッチングされる主要な部分の上にありません。その部分で除外されて"
        "いない頂点を選んでください。"
    ),
    "Landmarks {0} and {1} are at the same place of the {2}, at its vertices {3} and {4}. Remove one of them.": (
        "ランドマーク{0}と{1}は{2}の同じ場所（頂点{3}と{4}）にあります。一方を削除してください。"
    ),
    "{0} Coarse Points need at least as many Coarse Candidates, not {1}.": (
        "粗いポイント{0}個には、候補も同数以上必要です（現在{1}）。"
    ),
    "{0} points cannot be matched: the {1} has only {2} vertices{3}. Use fewer points or subdivide the mesh.": (
        "{0}個のポイントはマッチングできません。{1}の頂点は{2}個だけです{3}。ポイントを減らすか、メッシュを細"
        "分化してください。"
    ),
    '"{0}" cannot be written: {1}. Choose another place.': "「{0}」に書き込めません：{1}。別の場所を選んでください。",
    '"{0}" cannot be read: {1}. Choose another file.': "「{0}」を読み込めません：{1}。別のファイルを選んでください。",
    '"{0}" cannot be read: {1}.': "「{0}」を読み込めません：{1}。",
    '"{0}" is no text. Choose a file that HierMatch has written.': (
        '"{0}"はテキストではありません。HierMatchが書き出したファイルを選んでください。'
    ),
    '"{0}" is no name for a match file. Let it end with .npz or .json.': (
        "「{0}」は対応ファイルの名前ではありません。末尾を.npzか.jsonにしてください。"
    ),
    '"{0}" is no match that HierMatch has exported. Choose another file.': (
        "「{0}」はHierMatchが書き出した対応ではありません。別のファイルを選んでください。"
    ),
    '"{0}" was exported by a later version of HierMatch. Update the add-on.': (
        "「{0}」は新しいバージョンのHierMatchで書き出されています。アドオンを更新してください。"
    ),
    '"{0}" is damaged or no match file: {1}. Export the match again.': (
        "「{0}」は壊れているか、対応ファイルではありません：{1}。もう一度書き出してください。"
    ),
    'The match fits the other way round: "{0}" is its source and "{1}" its target. Exchange the two.': (
        "このマッチングは逆向きです。「{0}」がソース、「{1}」がターゲットです。二つを入れ替えてください。"
    ),
    (
        'The match does not fit "{0}": it was exported from a mesh with {1} vertices, and this one has {2}. '
        "Choose the mesh it was made for, or match again."
    ): (
        "マッチングが「{0}」に合いません。{1}頂点のメッシュから書き出されていますが、これは{2}頂点です。元の"
        "メッシュを選ぶか、もう一度マッチングしてください。"
    ),
    (
        'The match does not fit "{0}": its vertices or faces are numbered otherwise than on the mesh the match '
        "was exported from. Choose that mesh, or match again."
    ): (
        "マッチングが「{0}」に合いません。頂点か面の番号が書き出し元のメッシュと異なります。元のメッシュを選"
        "ぶか、もう一度マッチングしてください。"
    ),
    "{0} carry several matches. Name the Prefix of one of them: {1}.": (
        "{0}には複数のマッチングがあります。いずれかの接頭辞を指定してください：{1}。"
    ),
    "{0} carry no match with one another{1}. Match them first.": (
        "{0}の間に{1}マッチングはありません。先にマッチングしてください。"
    ),
    "The match of {0} has no dense map. Match them again with Dense Map on.": (
        "{0}のマッチングには密なマップがありません。密なマップをオンにしてもう一度マッチングしてください。"
    ),
    'The match of "{0}" and "{1}" has no dense map. Match them with Dense Map on.': (
        "「{0}」と「{1}」のマッチングには密なマップがありません。密なマップをオンにしてマッチングしてください。"
    ),
    "The dense map of {0} was removed from the attributes of a mesh. Match them again.": (
        "{0}の密なマップがメッシュの属性から削除されています。もう一度マッチングしてください。"
    ),
    (
        '"{0}" shares its mesh with other objects, which would change with it. Give it its own mesh first '
        "(Object > Relations > Make Single User > Object & Data)."
    ): (
        "「{0}」はほかのオブジェクトとメッシュを共有しており、それらも変わってしまいます。先に独立"
        "させてください（オブジェクト > 関係 > シングルユーザー化 > オブジェクトとデータ）。"
    ),
    '"{0}" is in Edit Mode. Switch to Object Mode first.': (
        "「{0}」は編集モードです。先にオブジェクトモードに切り替えてください。"
    ),
    (
        '"{0}" has no armature, so there is no rig to fit. Give it an Armature modifier with its armature, or '
        "pick another Source."
    ): (
        "「{0}」にはアーマチュアがなく、合わせるリグがありません。アーマチュアモディファイアーを付けるか、別"
        "のソースを選んでください。"
    ),
    (
        'No vertex of "{0}" is in a vertex group of a deforming bone of "{1}", so it is not known what the '
        "bones belong to. Bind the Source to its armature with weights first."
    ): (
        "「{0}」のどの頂点も「{1}」の変形ボーンの頂点グループに入っておらず、ボーンの対応が決まりません。先に"
        "ソースをウェイトでアーマチュアに関連付けてください。"
    ),
    'The armature "{0}" has a scale of zero. Set its scale first.': (
        "アーマチュア「{0}」のスケールが0です。先にスケールを設定してください。"
    ),
    'The armature "{0}" is mirrored by its scale. Apply that first (Object > Apply > Scale).': (
        "アーマチュア「{0}」はスケールで鏡像になっています。先に適用してください（オブジェクト > 適用 > スケール）。"
    ),
    'The armature "{0}" is in Edit Mode. Switch to Object Mode first.': (
        "アーマチュア「{0}」は編集モードです。先にオブジェクトモードに切り替えてください。"
    ),
    '"{0}" has no vertex groups, so there are no weights to carry over. Choose a weighted mesh as the Source.': (
        "「{0}」には頂点グループがなく、引き継ぐウェイトがありません。ウェイトのあるメッシュをソースに選んでください。"
    ),
    (
        '"{0}" has no armature whose bones could tell which vertex groups to carry. Carry All of them, or add an '
        "Armature modifier."
    ): (
        "「{0}」には、引き継ぐ頂点グループを決めるボーンを持つアーマチュアがありません。すべてを引き継ぐか、"
        "アーマチュアモディファイアーを追加してください。"
    ),
    'The active vertex group of "{0}" is one of a match. Select another one in its list of vertex groups.': (
        "「{0}」のアクティブな頂点グループはマッチングのものです。頂点グループのリストで別のものを選んでください。"
    ),
    'All vertex groups to carry are locked on "{0}". Unlock some of them, or carry others.': (
        "引き継ぐ頂点グループは「{0}」ですべてロックされています。ロックを外すか、別のものを引き継いでください。"
    ),
    '"{0}" already has something else called "{1}". Rename it, or turn Mark Rejected off.': (
        "「{0}」には別の「{1}」がすでにあります。名前を変えるか、除外の印をオフにしてください。"
    ),
    'Vertex groups of "{0}" for bones that move nothing of "{1}" were emptied: {2}.': (
        '"{1}"の何も動かさないボーンの"{0}"の頂点グループは空になりました: {2}。'
    ),
    (
        'Weights of {0} of {1} were taken from their neighbors: the map leads them astray, far from these on "{2}".'
    ): "{1}の{0}のウェイトは、マップが「{2}」上の離れた場所を指していたため、周囲から補いました。",
    '{0} of "{1}" was left out, because of values that are not finite numbers. Repair them.': (
        "「{1}」の{0}には有限の数でない値があるため、省かれました。値を修正してください。"
    ),
    'Locked shape keys of "{0}" were left alone: {1}.': (
        "「{0}」のロックされたシェイプキーはそのままにしました：{1}。"
    ),
    'Locked vertex groups of "{0}" were left alone: {1}.': (
        "「{0}」のロックされた頂点グループはそのままにしました：{1}。"
    ),
    '"{0}" has no weights for the bones of "{1}" yet. Transfer the weights as well.': (
        "「{0}」にはまだ「{1}」のボーンのウェイトがありません。ウェイトも転送してください。"
    ),
    'Constraints or drivers of "{0}" still point to {1}.': (
        "「{0}」のコンストレイントかドライバーはまだ{1}を指しています。"
    ),
    '"{0}" has no shape keys beside the basis, so there are none to carry over.': (
        "「{0}」にはベース以外のシェイプキーがなく、引き継ぐものがありません。"
    ),
    '"{0}" already has {1}, which was skipped.': "「{0}」にはすでに{1}があるため、飛ばしました。",
    '"{0}" has no UV map to carry over. Unwrap it, or choose another Source.': (
        "「{0}」には引き継ぐUVマップがありません。展開するか、別のソースを選んでください。"
    ),
    (
        '"{0}" has nothing of what is to be carried over: no such attributes, materials, marked edges or custom '
        "normals. Choose other options, or another Source."
    ): (
        "「{0}」には引き継ぐ属性、マテリアル、マークされた辺、カスタム法線がありません。別のオプションか、別"
        "のソースを選んでください。"
    ),
    (
        '"{0}" carries nothing of what is to be made symmetric: no vertex groups, shape keys or color '
        "attributes. Choose another object, or turn more of them on."
    ): (
        "「{0}」には対称にするものがありません（頂点グループ、シェイプキー、カラー属性）。別のオブジェクトを"
        "選ぶか、対象を増やしてください。"
    ),
    "{0} left out: {1}": "{0}は除外：{1}",
    'the rig "{0}" with {1}': "リグ「{0}」（{1}）",
    "1 bone": "ボーン1本",
    "{0} bones": "ボーン{0}本",
    "{0} vertex groups": "{0}個の頂点グループ",
    "{0} UV maps": "{0}個のUVマップ",
    "1 vertex group": "1個の頂点グループ",
    "{0} paired bones": "ペアにした{0}本のボーン",
    "1 paired bone": "ペアにした1本のボーン",
    "{0} actions": "{0}個のアクション",
    "1 action": "1個のアクション",
    "the pose": "ポーズ",
    "1 UV map": "1個のUVマップ",
    '"{0}" has no attribute "{1}". Check the Names.': "「{0}」に属性「{1}」はありません。名前を確認してください。",
    'The shape keys of "{0}" are absolute. Turn Relative on in its Shape Keys panel, or remove them.': (
        "「{0}」のシェイプキーは絶対値です。シェイプキーパネルで相対をオンにするか、削除してください。"
    ),
    (
        '"{0}" is the basis of the shape keys of "{1}", but a shape key of the source has the same name. Rename '
        "one of them."
    ): (
        "「{0}」は「{1}」のシェイプキーのベースですが、ソースに同じ名前のシェイプキーがあります。一方の名前を"
        "変えてください。"
    ),
    'The shape key "{0}" of "{1}" is locked. Unlock it, or take the item out.': (
        "「{1}」のシェイプキー「{0}」はロックされています。ロックを解除するか、このアイテムを外してください。"
    ),
    'The shape keys of "{0}" do not have the vertices of its mesh. Remove them first.': (
        "「{0}」のシェイプキーの頂点がメッシュと一致しません。先に削除してください。"
    ),
    'The active shape key of "{0}" is its basis. Select another one in its Shape Keys panel.': (
        "「{0}」のアクティブなシェイプキーはベースです。シェイプキーパネルで別のものを選択してください。"
    ),
    '"{0}" has no shape key {1}. Check the Names.': "「{0}」にシェイプキー{1}はありません。名前を確認してください。",
    '"{0}" would have {1} UV maps, but Blender allows {2}. Remove some of them first, or carry fewer over.': (
        "「{0}」のUVマップが{1}個になりますが、Blenderでは{2}個までです。先にいくつか削除するか、引き継ぐ数を"
        "減らしてください。"
    ),
    '"{0}" has no UV map "{1}". Check the Names.': "「{0}」にUVマップ「{1}」はありません。名前を確認してください。",
    "{0} landmarks were left out: the two meshes were mirrored in different ways there, by their match": (
        "{0}個のランドマークを除外しました。マッチングによると、そこでは二つのメッシュの左右反転の仕方が異なります"
    ),
    "Matching the coarse points exactly": "粗いポイントを厳密にマッチング中",
    "Matching the surface to itself": "表面を自身とマッチング中",
    "Comparing symmetries": "対称性を比較中",
    "Simplifying": "単純化中",
    "Fitting the rig": "リグを合わせています",
    "The {0} had {1} duplicate vertex along open seams: it was welded for matching.": (
        "{0}には開いた継ぎ目に沿って重複頂点が{1}個ありました。マッチングのために結合しました。"
    ),
    "The {0} had {1} duplicate vertices along open seams: they were welded for matching.": (
        "{0}には開いた継ぎ目に沿って重複頂点が{1}個ありました。マッチングのために結合しました。"
    ),
    "The {0} had {1} vertex at a gap between pieces: it was joined with the other border for matching.": (
        "{0}には部品の間の隙間に面した頂点が{1}個ありました。マッチングのために向かいの境界とつなぎました。"
    ),
    "The {0} had {1} vertices at gaps between pieces: they were joined with the other border for matching.": (
        "{0}には部品の間の隙間に面した頂点が{1}個ありました。マッチングのために向かいの境界とつなぎました。"
    ),
    "The {0} had {1} degenerate face: it was left out.": "{0}には縮退した面が{1}個ありました。除外しました。",
    "The {0} had {1} degenerate faces: they were left out.": "{0}には縮退した面が{1}個ありました。除外しました。",
    "The {0} had {1} repeated face: it was left out.": "{0}には重複した面が{1}個ありました。除外しました。",
    "The {0} had {1} repeated faces: they were left out.": "{0}には重複した面が{1}個ありました。除外しました。",
    "The {0} had {1} non-manifold edge: it was opened for matching.": (
        "{0}には非多様体の辺が{1}本ありました。マッチングのために切り開きました。"
    ),
    "The {0} had {1} non-manifold edges: they were opened for matching.": (
        "{0}には非多様体の辺が{1}本ありました。マッチングのために切り開きました。"
    ),
    "The {0} had {1} place where sheets touch in one vertex: it was separated for matching.": (
        "{0}には面どうしが一つの頂点で接している場所が{1}か所ありました。マッチングのために切り離しました。"
    ),
    "The {0} had {1} places where sheets touch in one vertex: they were separated for matching.": (
        "{0}には面どうしが一つの頂点で接している場所が{1}か所ありました。マッチングのために切り離しました。"
    ),
    "The {0} had {1} face of sheets that share an edge: it was left out.": (
        "{0}には一つの辺を共有する面の重なりに属する面が{1}個ありました。除外しました。"
    ),
    "The {0} had {1} faces of sheets that share an edge: they were left out.": (
        "{0}には一つの辺を共有する面の重なりに属する面が{1}個ありました。除外しました。"
    ),
    "The {0} had {1} face with normals against its neighbours: it was read the other way round.": (
        "{0}には法線が隣の面と逆向きの面が{1}個ありました。裏返して読み込みました。"
    ),
    "The {0} had {1} faces with normals against their neighbours: they were read the other way round.": (
        "{0}には法線が隣の面と逆向きの面が{1}個ありました。裏返して読み込みました。"
    ),
    "The {0} had {1} spike of one vertex: it was pulled in for matching.": (
        "{0}には頂点一つだけのとげが{1}個ありました。マッチングのために引き戻しました。"
    ),
    "The {0} had {1} spikes of one vertex: they were pulled in for matching.": (
        "{0}には頂点一つだけのとげが{1}個ありました。マッチングのために引き戻しました。"
    ),
    "The {0} had {1} small hole: it was closed for matching.": (
        "{0}には小さな穴が{1}個ありました。マッチングのためにふさぎました。"
    ),
    "The {0} had {1} small holes: they were closed for matching.": (
        "{0}には小さな穴が{1}個ありました。マッチングのためにふさぎました。"
    ),
    "The {0} had a surface with only one side: it was cut open for matching.": (
        "{0}には表裏の区別がない面がありました。マッチングのために切り開きました。"
    ),
    "The normals of the {0} point inwards: they were read the other way round.": (
        "{0}の法線は内側を向いています。裏返して読み込みました。"
    ),
    "The {0} has {1} large opening: the surface ends there.": (
        "{0}には大きな開口部が{1}個あります。表面はそこで終わるものとします。"
    ),
    "The {0} has {1} large openings: the surface ends there.": (
        "{0}には大きな開口部が{1}個あります。表面はそこで終わるものとします。"
    ),
    "The {0} is made of {1} pieces: one surface around all of them was matched.": (
        "{0}は {1} 個のピースでできています: すべてを包む 1 つのサーフェスでマッチしました。"
    ),
    "The {0} has {1} smaller part: it follows its surroundings.": (
        "{0}には小さなパーツが{1}個あります。周囲に従います。"
    ),
    "The {0} has {1} smaller parts: they follow their surroundings.": (
        "{0}には小さなパーツが{1}個あります。周囲に従います。"
    ),
    "The {0} has {1} loose vertex: it follows its surroundings.": (
        "{0}には孤立した頂点が{1}個あります。周囲に従います。"
    ),
    "The {0} has {1} loose vertices: they follow their surroundings.": (
        "{0}には孤立した頂点が{1}個あります。周囲に従います。"
    ),
    '"{0}" already has something else called "{1}", so that attribute was left out. Rename one of them.': (
        "「{0}」には「{1}」という別のものがすでにあるため、その属性は除外しました。一方の名前を変えてください。"
    ),
    'The attribute "{0}" of "{1}" is of the type {2}, and was left out.': (
        "「{1}」の属性「{0}」は{2}型のため、除外しました。"
    ),
    ('{0} is moved by the armature "{1}" as well. Remove that Armature modifier unless both are meant to move it.'): (
        "{0}はアーマチュア「{1}」でも動きます。両方で動かすつもりでなければ、そのアーマチュアモディファイアーを"
        "削除してください。"
    ),
    '{0} keeps its parent "{1}".': "{0}の親は「{1}」のままです。",
    'The NLA tracks of the shape keys of "{0}" were left out.': "「{0}」のシェイプキーのNLAトラックは除外しました。",
    'The shape keys of "{0}" keep their own action "{1}".': "「{0}」のシェイプキーのアクションは「{1}」のままです。",
    "The imported match has no dense map: only its points were written, without colors and distortion.": (
        "読み込んだマッチングには密なマップがないため、ポイントだけを書き込みました。色と歪みはありません。"
    ),
    '{0} of "{1}" run where the target has no faces, and were left out.': (
        "「{1}」の{0}はターゲットに面のない場所を通るため、除外しました。"
    ),
    "1 landmark": "1個のランドマーク",
    "{0} landmarks": "{0}個のランドマーク",
    "1 line": "1本の線",
    "{0} lines": "{0}本の線",
    '"{0}" is moved by {1} as well as by "{2}". Only the latter was fitted.': (
        "「{0}」は「{2}」のほかに{1}でも動きます。「{2}」だけを合わせました。"
    ),
    "The target seems to be in its rest pose already, so none was made. If it is posed, set Pose to Posed.": (
        "ターゲットはすでにレストポーズのようなので、レストポーズは作成しませんでした。ポーズが付いている場合は、ポ"
        "ーズを「ポーズあり」にしてください。"
    ),
    '"{0}", which was made before, lacks {1}.': "以前に作成した「{0}」には{1}がありません。",
    'Constraints or drivers move {0} of "{1}" away from rest, and the target with them. Check them.': (
        "コンストレイントかドライバーが「{1}」の{0}を、ターゲットとともにレスト位置からずらしています。確認してくだ"
        "さい。"
    ),
    'The shape keys of "{0}" are absolute; on "{1}", which has others, they are relative.': (
        "「{0}」のシェイプキーは絶対ですが、ほかのキーがある「{1}」では相対になります。"
    ),
    '"{0}" has no vertex group {1}, by which shape keys of "{2}" are limited. Carry the weights over first.': (
        "「{2}」のシェイプキーを制限する頂点グループ{1}が「{0}」にありません。先にウェイトを引き継いでください。"
    ),
    'Drivers of the shape keys of "{0}" still point to {1}.': (
        "「{0}」のシェイプキーのドライバーがまだ{1}を指しています。"
    ),
    (
        '"{0}" already has a vertex group or another attribute called "{1}", so that UV map was left out. Rename one '
        "of them."
    ): (
        "「{0}」には「{1}」という頂点グループか別の属性がすでにあるため、そのUVマップは除外しました。一方の名前を変"
        "えてください。"
    ),
    ('{0} of {1} islands of {2} lie where "{3}" has no faces, such as the inside of a mouth that only "{4}" has.'): (
        "{2}のアイランド{1}個のうち{0}個は、「{4}」にしかない口の中のように、「{3}」に面のない場所にあります。"
    ),
    '{0} of {1} islands of {2} lie where the match has no confidence. Check them on "{3}".': (
        "{2}のアイランド{1}個のうち{0}個は、マッチングの信頼度がない場所にあります。「{3}」で確認してください。"
    ),
    '{0} of "{1}" was left out: on "{2}" a match wrote what has that name.': (
        "「{1}」の{0}は除外しました。「{2}」ではマッチングが同じ名前のものを書き込んでいます。"
    ),
    "1 vertex": "1個の頂点",
    "{0} vertices": "{0}個の頂点",
    "{0} of the vertices have no place on the other mesh and follow their surroundings.": (
        "頂点の{0}はもう一方のメッシュに対応する場所がなく、周囲に従います。"
    ),
    'Custom normals of "{0}" bend with the key only roughly along seams. With the result New Object they fit the '
    "wrapped surface.": (
        "「{0}」のカスタム法線は、シームに沿ってはキーにおおよそしか従いません。結果を新規オブジェクトにすると、"
        "ラップした表面に合います。"
    ),
    "The wrapped surface is folded in places, {0} of it.": (
        "ラップした表面はところどころ折れ重なっています（全体の{0}）。"
    ),
    "{0} and {1} more": "{0}ほか{1}個",
    'Carried to "{0}": {1}': "「{0}」に引き継ぎました：{1}",
    'Found for "{0}": {1}': "「{0}」について見つけました：{1}",
    'the rig "{0}" with {1} and the rest pose "{2}"': "リグ「{0}」（{1}）とレストポーズ「{2}」",
    "updated": "更新済み",
    "a new object": "新しいオブジェクト",
    'the shape key "{0}" on "{1}"': "「{1}」のシェイプキー「{0}」",
    'the shape key "{0}" on {1} objects': "{1}個のオブジェクトのシェイプキー「{0}」",
    "{0} new objects": "{0}個の新しいオブジェクト",
    'the action "{0}"': "アクション「{0}」",
    "custom normals": "カスタム法線",
    "1 attribute": "1個の属性",
    "{0} attributes": "{0}個の属性",
    "1 material": "1個のマテリアル",
    "{0} materials": "{0}個のマテリアル",
    "1 shape key": "1個のシェイプキー",
    "{0} shape keys": "{0}個のシェイプキー",
    "1 driver": "1個のドライバー",
    "{0} drivers": "{0}個のドライバー",
    "1 color attribute": "1個のカラー属性",
    "{0} color attributes": "{0}個のカラー属性",
    "Unlocked {0}": "{0}のロックを解除しました",
    "Removed {0}": "{0}を削除しました",
    "Landmark {0} is {1}": "ランドマーク{0}を{1}にしました",
    "on": "オン",
    "off": "オフ",
    "nothing": "なし",
    ('No bone of "{0}" that deforms has a vertex group on "{1}". Carry All groups, or turn Deform on for its bones.'): (
        "「{0}」の変形するボーンには「{1}」に頂点グループを持つものがありません。すべてのグループを引き継ぐか、ボー"
        "ンの変形をオンにしてください。"
    ),
    (
        'No bone of "{0}" that is selected has a vertex group on "{1}". Carry All groups, or select others of its '
        "bones in Pose Mode."
    ): (
        "「{0}」の選択中のボーンには「{1}」に頂点グループを持つものがありません。すべてのグループを引き継ぐか、ポー"
        "ズモードでほかのボーンを選択してください。"
    ),
    "1 note": "注記1件",
    "{0} notes": "注記{0}件",
    "Fit My Rig": "マイリグをフィット",
    "My Rig": "マイリグ",
    (
        "Give the matched meshes a copy each of an armature that stands in the source, such as a metarig "
        "of Rigify or a standard skeleton, with its joints where they belong in them. It need not move "
        "the source"
    ): (
        "ソースの中に立つアーマチュア、たとえばRigifyのメタリグや標準スケルトンのコピーを、対応づけたメッ"
        "シュそれぞれに、関節を正しい位置に置いて与えます。ソースを動かしていなくても構いません"
    ),
    (
        "Name of an armature that stands in the source without moving it, such as a metarig of Rigify. "
        "It may be bound to nothing"
    ): (
        "ソースの中に立ち、ソースを動かしていないアーマチュアの名前。Rigifyのメタリグなど。何にもバインド"
        "されていなくて構いません"
    ),
    "Bind with Weights": "ウェイトでバインド",
    (
        "Bind the target to the fitted rig, with the weights of the source's own rig, handed to the "
        "bones that move the same surface. Leave it off for a metarig"
    ): (
        "ソース自身のリグのウェイトを、同じ表面を動かすボーンに渡して、ターゲットをフィットしたリグにバイ"
        "ンドします。メタリグではオフのままにしてください"
    ),
    (
        '"{0}" moves no mesh, so nothing tells where in a body its joints belong. Choose as the Source a '
        "mesh in which it stands, and name the armature as the Rig."
    ): (
        "「{0}」はどのメッシュも動かしていないため、関節が体のどこにあるべきか分かりません。それが中に立"
        "つメッシュをソースに選び、アーマチュアをリグとして指定してください。"
    ),
    ('"{0}" moves "{1}". To give a target the rig that moves the source, use Retarget with Rig on.'): (
        "「{0}」は「{1}」を動かしています。ソースを動かすリグをターゲットに与えるには、「リグ」をオンにし"
        "て「リターゲット」を使ってください。"
    ),
    "Which armature is to be fitted is open. Name one as the Rig.": (
        "フィットするアーマチュアが分かりません。リグとして一つ指定してください。"
    ),
    '"{0}" is not an armature. Name one as the Rig.': (
        "「{0}」はアーマチュアではありません。リグとしてアーマチュアを指定してください。"
    ),
    (
        '"{0}" does not stand in "{1}": most of its bones lie outside, also if it is moved there and '
        "scaled. Move its joints into that body in Edit Mode first."
    ): (
        "「{0}」は「{1}」の中に立っていません。そこへ移動して拡大縮小しても、ほとんどのボーンが外にありま"
        "す。先に編集モードで関節をその体の中に移してください。"
    ),
    (
        '"{0}" has no weights that could be handed to the bones of "{1}". Switch Bind with Weights off, '
        "and bind the target by Blender's automatic weights afterwards."
    ): (
        "「{0}」には「{1}」のボーンに渡せるウェイトがありません。「ウェイト付きでバインド」をオフにして、"
        "後で Blenderの自動ウェイトでターゲットをバインドしてください。"
    ),
    "Carrying joints": "関節を移しています",
    '"{0}" moves nothing yet. Generate its control rig, or bind "{1}" to it.': (
        "「{0}」はまだ何も動かしていません。コントロールリグを生成するか、「{1}」をそれにバインドしてください。"
    ),
    '"{0}" did not stand in "{1}", so it was moved there and scaled.': (
        "「{0}」は「{1}」の中に立っていなかったため、そこへ移動して拡大縮小しました。"
    ),
    "Rename Bones": "ボーンの名前を変更",
    (
        "Give the bones of the target's rig the names of a standard, or of the source's bones. Vertex "
        "groups, actions, constraints and drivers follow"
    ): (
        "ターゲットのリグのボーンに、規格の名前か、ソースのボーンの名前を付けます。頂点グループ、アクショ"
        "ン、コンストレイント、ドライバーも追従します"
    ),
    ("Name of an armature, or of what it moves; if empty, the one picked in the panel or else the active object"): (
        "アーマチュア、またはそれが動かすものの名前。空の場合はパネルで選んだもの、なければアクティブオブジェクト"
    ),
    (
        "Name of the armature whose names are taken over, or of what it moves; if empty, the one picked in the panel"
    ): "名前を引き継ぐアーマチュア、またはそれが動かすものの名前。空の場合はパネルで選んだもの",
    "What the bones are to be called": "ボーンに付ける名前",
    "Names of the humanoid bones of VRM 1.0, such as leftUpperArm": (
        "VRM 1.0のヒューマノイドボーンの名前。leftUpperArmなど"
    ),
    "Names of Mixamo, such as mixamorig:LeftArm": "Mixamoの名前。mixamorig:LeftArmなど",
    "Names of Unreal's mannequin, such as upperarm_l": "Unrealのマネキンの名前。upperarm_lなど",
    "Names of the bones of Rigify that deform, such as DEF-upper_arm.L": (
        "Rigifyの変形ボーンの名前。DEF-upper_arm.Lなど"
    ),
    "The names of the source's bones with which they are paired, whatever they move": (
        "ペアになっているソースのボーンの名前"
    ),
    "Known by": "判断の手がかり",
    "What tells which bone is which, for a standard": ("規格の名前を付けるとき、どのボーンが何かを何で判断するか"),
    "Joints": "関節",
    "Where the joints are, and what hangs on what. Names do not matter": ("関節の位置と親子関係。名前は関係ありません"),
    '{0} of "{1}" got another name': "「{1}」の{0}の名前を変更しました",
    "{0} kept the name: there is none for it": "{0}は該当する名前がないため元の名前のままです",
    (
        'The bones of "{0}" are linked from another file and cannot be renamed here. Make it local first '
        "(Object > Relations > Make Local)."
    ): (
        "「{0}」のボーンは別のファイルからリンクされているため、ここでは名前を変更できません。先にローカ"
        "ル化してください（オブジェクト > 関係 > ローカル化）。"
    ),
    'No bone of "{0}" has a name of that standard. Choose another one.': (
        "「{0}」にはその規格の名前のボーンがありません。別のものを選んでください。"
    ),
    '"{0}" has other bones that are called {1} already. Rename them first.': (
        "「{0}」にはすでに{1}という別のボーンがあります。先にその名前を変更してください。"
    ),
    '"{0}" has other vertex groups that are called {1} already. Rename them first.': (
        "「{0}」にはすでに{1}という別の頂点グループがあります。先にその名前を変更してください。"
    ),
    '"{0}" plays {1} as well, and would no longer be moved by it. Give "{2}" a copy first: press the number beside its '
    "name in the Action Editor.": (
        '"{0}"も{1}を再生しており、それでは動かなくなります。先に"{2}"へコピーを割り当ててください。アクションエディターで'
        "名前の横の数字を押します。"
    ),
    "Posing controls": "コントロールのポーズを求めています",
    "Looking for controls": "コントロールを探しています",
    '{0} of "{1}" was set so that its bones follow the controls with keys.': (
        "「{1}」のボーンがキーのあるコントロールに従うように、{0}を設定しました。"
    ),
    'No control turns {0} of "{1}".': "「{1}」の{0}を回すコントロールがありません。",
    '{0} of "{1}" could not be turned as they should be by their controls.': (
        "「{1}」の{0}は、コントロールでは正しい向きにできませんでした。"
    ),
}
"""The translation of each English text."""
