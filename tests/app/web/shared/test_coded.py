"""Pages show text between backticks in sentences of models and templates as code."""

import pytest

from app.presentation.environment import coded


@pytest.mark.parametrize(
    ("sentence", "html"),
    [
        ("as `oil_film` 2 has it", "as <code>oil_film</code> 2 has it"),
        ("`<b>` and x < y", "<code>&lt;b&gt;</code> and x &lt; y"),
        ("one ` alone < 2", "one ` alone &lt; 2"),
    ],
)
def test_a_name_between_backticks_is_code_and_all_is_escaped(sentence, html):
    assert coded(sentence) == html
