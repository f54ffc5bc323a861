# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that anybody may have made."""

from __future__ import annotations

import json

import pytest
from hiermatch.hiermatch_addon.common.file_reading import parsed_json, read_text


@pytest.mark.parametrize("plain", [{"name": "左目 \U0001f441"}, [1, "\\u", "\\d800"]])
@pytest.mark.parametrize("is_ascii", [False, True])
def test_texts_come_back(plain, is_ascii):
    assert parsed_json(json.dumps(plain, ensure_ascii=is_ascii)) == plain


@pytest.mark.parametrize("text", ["", "[" * 100_000, '["\\ud800"]', '{"\\uDC00": 1}', '["a\\u0000b"]', '["a\0b"]'])
def test_what_no_text_can_be_is_refused(text):
    with pytest.raises(ValueError, match=r"\w"):
        parsed_json(text)


def test_the_mark_at_the_beginning_is_none_of_the_text(tmp_path):
    (tmp_path / "file").write_bytes(b"\xef\xbb\xbftext")
    assert read_text(tmp_path / "file") == "text"
