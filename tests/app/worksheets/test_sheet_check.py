"""`check` returns the right results for a text, and survives hostile texts."""

import pytest
from serving import API, HANG, faults, problem
from sheets import BUSH, FAULTY, drafted, fresh, place

LARGEST = 65_536


def checked(http, text, **more):
    answer = http.post(f"{API}/worksheets/check", json={"text": text, **more}, timeout=4 * HANG)
    assert answer.status_code == 200, answer.text[:2000]
    return answer.json()


def by_kind(check):
    return {line["kind"]: line for line in check["lines"]}


def test_every_line_has_the_numbers_of_the_example(http):
    check = checked(http, BUSH)
    lines = {line["name"]: line for line in check["lines"]}
    assert (lines["F"]["value"], lines["F"]["unit"]) == (25, "kN")
    assert lines["B"]["value"] == 24
    assert lines["p"]["value"] == pytest.approx(25e3 / (48e-3 * 24e-3) / 1e6)
    assert lines["p"]["unit"] == "MPa"
    assert [line["line"] for line in check["lines"]] == sorted(line["line"] for line in check["lines"])
    assert {line["kind"] for line in check["lines"]} == {
        "prose", "given", "formula", "require", "check", "test"
    }  # fmt: skip


def test_formulas_and_rules_are_on_paper(http):
    lines = by_kind(checked(http, BUSH))
    for kind in ("formula", "require", "check"):
        assert lines[kind]["mathml"].startswith("<math")
    assert (lines["require"]["verdict"], lines["check"]["verdict"]) == ("met", "met")
    assert "21.7 MPa" in lines["check"]["message"]


def test_the_example_may_miss_a_check_and_a_rule(http):
    lines = by_kind(checked(http, BUSH.replace("p <= 30 MPa", "p <= 20 MPa")))
    assert lines["check"]["verdict"] == "not_met"
    lines = by_kind(checked(http, BUSH.replace("B <= 2 * D", "B <= D / 4")))
    assert lines["require"]["verdict"] == "not_met"
    assert "twice as long" in lines["require"]["message"]
    assert lines["formula"]["value"] is None


def test_a_value_outside_its_published_range_is_warned_of(http):
    formula = 'p [MPa] = F / (D * B) "projected pressure"'
    assert formula in BUSH
    for greatest, words in ((20, "≤ 20 MPa"), (40, None)):
        check = checked(http, BUSH.replace(formula, f"{formula} (published 1 to {greatest})"))
        line = next(line for line in check["lines"] if line["name"] == "p")
        assert line["value"] == pytest.approx(25e3 / (48e-3 * 24e-3) / 1e6)
        assert words in line["message"] if words else line["message"] is None


def test_the_template_is_described(http):
    check = checked(http, BUSH, id="bush_duty")
    assert check["template"]["id"] == "bush_duty"
    assert set(check["template"]["inputs"]["properties"]) == {
        "radial_load", "bearing_diameter", "bearing_width"
    }  # fmt: skip
    assert [name["name"] for name in check["names"]] == ["F", "D", "B", "p", "bore"]
    assert check["tests"] == [
        {"line": 13, "words": "by hand", "passed": True, "message": check["tests"][0]["message"]}
    ]


def test_a_faulty_text_is_no_error_of_the_request(http):
    check = checked(http, FAULTY)
    assert check["digest"] is check["template"] is None
    assert check["title"] == "Bush duty"
    first = check["faults"][0]
    assert (first["line"], first["code"]) == (8, "unit_mismatch")
    assert first["column"] >= 1
    assert first["message"]


def test_nothing_is_saved(http):
    before = http.get(f"{API}/worksheets", params={"limit": 500}).json()
    id = fresh()
    checked(http, BUSH, id=id)
    problem(http.get(place(id)), 404, "not-found")
    assert http.get(f"{API}/worksheets", params={"limit": 500}).json() == before


@pytest.mark.parametrize(
    ("prose", "html"),
    [
        ("**bold** and *italic*", "<p><strong>bold</strong> and <em>italic</em></p>"),
        ("[a](https://a.example)", '<p><a href="https://a.example">a</a></p>'),
        ("[a](mailto:a@b.example)", '<p><a href="mailto:a@b.example">a</a></p>'),
        ("[a](javascript:alert)", "<p>[a](javascript:alert)</p>"),
        ("[a](JavaScript:alert)", "<p>[a](JavaScript:alert)</p>"),
        ("[a](//other.example)", "<p>[a](//other.example)</p>"),
        ("[a](/designs)", "<p>[a](/designs)</p>"),
        ("[a](data:text/html,x)", "<p>[a](data:text/html,x)</p>"),
        ("<script>alert(1)</script>", "<p>&lt;script&gt;alert(1)&lt;/script&gt;</p>"),
        ("a <b onclick=x>b</b>", "<p>a &lt;b onclick=x&gt;b&lt;/b&gt;</p>"),
        ('[a](https://a.example"onclick=x)', '<p><a href="https://a.example%22onclick=x">a</a></p>'),
    ],
)
def test_prose_becomes_safe_html(http, prose, html):
    check = checked(http, f"# T\n> {prose}\n{BUSH}")
    assert check["lines"][1]["html"] == html


def test_pictures_are_text(http):
    check = checked(http, f"# T\n> ![a](https://a.example/a.png)\n{BUSH}")
    assert "<img" not in check["lines"][1]["html"]


HOSTILE = {
    "nothing": "",
    "blanks": " \n\t\n",
    "long": "x" * LARGEST,
    "too long": "// " + "x" * LARGEST,
    "too long in bytes": "> " + "ä" * (LARGEST - 100),
    "brackets": "> " + "[" * 60_000,
    "stars": "\n".join(["> " + "*a " * 600] * 30),
    "quotes": ">" * 60_000,
    "parentheses": "p [m] = " + "(" * 1900 + "1 m" + ")" * 10 + ' "p"',
    "power": 'p [1] = 9**9**9**9**9 "p"',
    "unit": 'given x [m**9**9**9] "x"',
    "python": 'p [m] = ().__class__.__bases__[0] "p"',
    "import": '__import__("os").system("true")',
    "lines": "\n" * 60_000,
    "controls": "".join(map(chr, range(1, 32))),
    "right to left": 'given \u202ex\u202c [m] "\u202ewords" (example 1 m)',
    "loop": 'a [1] = b "a"\nb [1] = a "b"',
    "twice": 'a [1] = 1 "a"\na [1] = 2 "a"',
}


@pytest.mark.parametrize("name", HOSTILE)
@pytest.mark.sampled(4)
def test_hostile_texts_get_an_answer(http, name):
    check = checked(http, HOSTILE[name])
    assert check["faults"] or check["lines"] == [] or check["template"] is not None


@pytest.mark.parametrize("path", ["", "/check", "/bush"])
@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("given x\0 [m]", "character 8"),
        ("# Bush\n> two\n\0\n", "line 3, column 1"),
        ('given x [m] "x"\r\ny\0 [m] = x "y"\0', "line 2, column 2"),
    ],
)
def test_a_text_with_nul_is_refused_as_in_every_request_and_its_place_is_named(http, path, text, place):
    method = "PATCH" if path == "/bush" else "POST"
    answer = http.request(method, f"{API}/worksheets{path}", json={"text": text}, headers={"If-Match": "*"})
    assert answer.status_code == 422
    [fault] = answer.json()["errors"]
    assert (fault["name"], fault["code"]) == ("text", "nul")
    assert fault["detail"] == f"no text may contain the character U+0000 (NUL); remove it: {place}"


def test_doubling_functions_are_refused(http):
    functions = ["f0(x [1]) [1] = x + x", *(f"f{n}(x [1]) [1] = f{n - 1}(f{n - 1}(x))" for n in range(1, 30))]
    text = "\n".join(['given x [1] "x" (example 1)', *functions, 'y [1] = f29(x) "y"'])
    check = checked(http, text)
    assert "too_large" in {fault["code"] for fault in check["faults"]}


@pytest.mark.parametrize("path", ["", "/check"])
@pytest.mark.parametrize(
    "body",
    [b"", b"{", b"[]", b'"text"', b'{"text": 5}', b'{"text": ["a"]}', b'{"text": "\\ud800", "id": "s"}',
     b'{"text": "a", "other": 1}', b'{"text": null}'],
)  # fmt: skip
def test_bodies_that_are_no_text_are_refused(http, path, body):
    answer = http.post(f"{API}/worksheets{path}", content=body, headers={"Content-Type": "application/json"})
    problem(answer, 422, "invalid-inputs")


def test_other_types_are_refused(http):
    answer = http.post(f"{API}/worksheets/check", content=BUSH, headers={"Content-Type": "text/plain"})
    problem(answer, 415, "unsupported-media-type")


@pytest.mark.parametrize("text", ["x" * (LARGEST + 1), "ä" * (LARGEST // 2 + 1), "a\nb\0"])
def test_what_cannot_be_kept_is_refused(http, text):
    wrong = faults(http.post(f"{API}/worksheets", json={"id": fresh(), "text": text}))
    assert set(wrong) == {"text"}
    sheet = drafted(http)
    answer = http.patch(place(sheet["id"]), json={"text": text}, headers={"If-Match": "*"})
    assert set(faults(answer)) == {"text"}


def test_as_much_as_may_be_is_kept(http):
    text = BUSH + "// " + "x" * (LARGEST - len(BUSH) - 3)
    assert drafted(http, text)["text"] == text


def test_names_of_people_are_text(http):
    for author in ("", " ", "a\nb", "x" * 101, "\x7f"):
        body = {"id": fresh(), "text": BUSH, "author": author}
        assert set(faults(http.post(f"{API}/worksheets", json=body))) == {"author"}


def test_sound_lines_show_their_numbers_beside_faulty_ones(http):
    lines = BUSH.splitlines()
    place = next(number for number, line in enumerate(lines) if line.startswith("p ["))
    faulty = ['wrong [MPa] = F + D "no sum"', 'more [MPa] = 2 * wrong "twice that"']
    check = checked(http, "\n".join([*lines[:place], *faulty, *lines[place:]]))
    assert [fault["line"] for fault in check["faults"]] == [place + 1]
    shown = {line["name"]: line for line in check["lines"]}
    assert shown["p"]["value"] == pytest.approx(25e3 / (48e-3 * 24e-3) / 1e6)
    assert shown["p"]["line"] == place + 3
    assert not {"wrong", "more"} & shown.keys()
    assert {"F", "p"} <= {name["name"] for name in check["names"]}
    assert check["template"] is None
    assert check["digest"] is None
