"""The header of a STEP file from a client is read in linear time."""

import pytest
from scaling import assert_constant, assert_linear

from cad.header import LONGEST_HEADER, read_header
from cad.part21 import description, plain, quoted, tokens

START = "FILE_DESCRIPTION(("
STEP = {
    "the reproducer": lambda n: START + "''" * n,
    "quotes, odd": lambda n: START + "'" * (2 * n + 1),
    "strings without commas": lambda n: START + "'a' " * n,
    "strings with commas": lambda n: START + "'a'," * n,
    "strings, one not closed": lambda n: START + "'a'," * n + "'",
    "empty strings, blanks": lambda n: START + "'' \n" * n + ")",
    "a long string": lambda n: START + "'" + "a" * n + "'),'2;1');",
    "a string of lines": lambda n: START + "'" + "a\r\n" * n + "'),'2;1');",
    "nested lists": lambda n: START + "(" * n + "'a'" + ")" * n,
    "lists side by side": lambda n: START + "('a')," * n,
    "starts": lambda n: "FILE_DESCRIPTION(" * n,
    "starts in a string": lambda n: "'" + START * n,
    "starts in a comment": lambda n: "/*" + START * n,
    "comments": lambda n: START + "/* ' */" * n,
    "comments, not closed": lambda n: START + "/*" * n,
    "stars": lambda n: "/*" + "*" * n,
    "blanks": lambda n: "FILE_DESCRIPTION" + " " * n + "(",
    "a long word": lambda n: "F" * n,
    "wide, not closed": lambda n: START + "'" + "\\X2\\" * n + "')",
    "wide digits, not closed": lambda n: START + "'\\X2\\" + "0041" * n + "')",
    "backslashes": lambda n: START + "'" + "\\" * n + "')",
    "a title's digits": lambda n: START + "'Crankwright a version " + "9" * n + "')",
    "no end of the section": lambda n: "ENDSEC" * n,
}


class TestStep:
    @pytest.mark.parametrize("make", STEP.values(), ids=STEP)
    @pytest.mark.sampled(3)
    def test_the_scan(self, make):
        assert_linear(description, make, 10_000)

    @pytest.mark.parametrize("make", STEP.values(), ids=STEP)
    @pytest.mark.sampled(3)
    def test_a_header(self, make):
        def read(step):
            assert read_header(step) is None

        assert_linear(read, lambda n: make(n // 8).encode(), LONGEST_HEADER // 4)

    @pytest.mark.parametrize("make", STEP.values(), ids=STEP)
    @pytest.mark.sampled(3)
    def test_no_more_than_the_header_is_read(self, make):
        assert_constant(read_header, lambda n: make(n).encode().ljust(LONGEST_HEADER), 100_000)

    def test_a_string_back_and_forth(self):
        assert_linear(lambda text: plain(quoted(text)), lambda n: "'\\轴 承" * n, 5000)

    def test_tokens_pass_over_comments_and_keep_strings_whole(self):
        assert list(tokens("A/* ' */('it''s'/**/,'\n')B 'x")) == [
            "A",
            "(",
            "'it''s'",
            ",",
            "'\n'",
            ")",
            "B",
            "'x",
        ]

    @pytest.mark.parametrize(
        ("text", "expected"),
        [
            (START + "'a','b'),'2;1');", ["'a'", "'b'"]),
            (START + "'a' 'b',),'2;1');", ["'a'", "'b'"]),
            ("FILE_DESCRIPTION /* x */ (\n (\r\n'a''b' , 'ENDSEC;'\n) ,'2;1');", ["'a''b'", "'ENDSEC;'"]),
            ("/* FILE_DESCRIPTION(('x')) */" + START + "'a'),'2;1');", ["'a'"]),
            ("X('FILE_DESCRIPTION((''x''),');" + START + "'a'),'2;1');", ["'a'"]),
            (START + "),'2;1');", []),
            (START + "'a'", []),
            (START + "'a", []),
            (START + "('a')),'2;1');", []),
            (START + "a),'2;1');", []),
            ("FILE_DESCRIPTION('a','2;1');", []),
            ("ENDSEC;" + START + "'a'),'2;1');", []),
        ],
    )
    def test_the_description_is_read_from_the_header(self, text, expected):
        assert description(text) == expected
