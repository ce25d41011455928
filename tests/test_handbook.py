"""The documentation agrees with the code: README, tutorial, how-to pages, and generated pages."""

import ast
import json
import re
from pathlib import Path

import pytest
from markupsafe import escape

from cad.catalogue import models as cad_models
from cad.regenerate import regenerate
from handbook import client, criteria, decisions, language, map_of_code, models, rest, templates
from handbook.signatures import prose, signature
from templates import get
from templates.door import built_in
from templates.library.tables import tables

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")
TUTORIAL = (ROOT / "docs" / "tutorial.md").read_text(encoding="utf-8")
COMMANDS = (
    "python3 -m venv .venv && .venv/bin/pip install -c constraints.txt -e . && .venv/bin/crankwright demo",
    'python3 -m venv .venv && .venv/bin/pip install -c constraints.txt -e ".[test]" && .venv/bin/pytest -n 2',
)


def blocks(text, kind):
    return re.findall(rf"^```{kind}\n(.*?)^```", text, re.MULTILINE | re.DOTALL)


def test_the_readme_is_short_and_has_the_two_commands():
    assert len(README.split()) <= 720
    assert tuple(block.strip() for block in blocks(README, "sh"))[:2] == COMMANDS
    assert "No licence has been chosen" in README


def test_the_readme_begins_with_four_lines_of_the_comparison():
    comparison = (ROOT / "docs" / "comparison.md").read_text(encoding="utf-8").splitlines()
    table = [line for line in README.splitlines()[:10] if line.startswith("| ")]
    assert len(table) == 1 + 4
    assert set(table) <= set(comparison)


@pytest.mark.parametrize("id", [*built_in().ids, *cad_models().ids])
def test_the_readme_names_every_template_and_model(id):
    assert f"`{id}`" in README


def tutorial_film(scale, **changes):
    """The film of the tutorial's design at a scale."""
    document = json.loads(blocks(TUTORIAL, "json")[1])
    inputs = {**document["steps"]["film"]["inputs"], "bearing_diameter": f"{scale * 48} mm", **changes}
    return get("oil_film", 2)(**inputs).minimum_film_thickness.to("um").magnitude


def test_the_numbers_of_the_tutorial_are_right():
    answer = json.loads("{" + blocks(TUTORIAL, "json")[0] + "}")
    assert answer["outputs"]["minimum_film_thickness"]["value"] == pytest.approx(tutorial_film(1), rel=1e-8)
    assert f"The film is {tutorial_film(1):.2f} µm thick" in TUTORIAL
    assert f"a film of {tutorial_film(1.05):.2f} µm" in TUTORIAL
    assert f"revision 3 is {tutorial_film(1.05, bearing_width='24.4 mm'):.2f} µm thick" in TUTORIAL
    assert "one root, 24.23 mm" in TUTORIAL
    assert tutorial_film(1, bearing_width="24.225 mm") < 4 < tutorial_film(1, bearing_width="24.235 mm")


def test_the_example_of_templates_from_python_is_right():
    page = (ROOT / "docs" / "howto" / "python.md").read_text(encoding="utf-8")
    code = blocks(page, "python")[0]
    names = {}
    exec(code, names)
    said = dict(re.findall(r"^(film\.\S+)  # (.*)$", code, re.MULTILINE))
    film = names["film"]
    assert said["film.minimum_film_thickness"].startswith(f"{film.minimum_film_thickness:.4g~P},")
    for text in ("film.level", 'film.error["minimum_film_thickness"]', "film.warnings"):
        assert eval(text, names) == ast.literal_eval(said[text])


def test_the_page_for_users_of_ross_and_opentorsion_is_right():
    page = (ROOT / "docs" / "howto" / "ross_opentorsion.md").read_text(encoding="utf-8")
    names = {}
    for code in blocks(page, "python"):
        exec(code, names)
    for name, ours in re.findall(r"`(stiffness_[xy]{2})` (−?[\d.]+)", page):
        value = getattr(names["bearing"], name).to("MN/m").magnitude
        assert f"{value:.6f}" == ours.replace("−", "-")
    frequencies = names["shaft"].natural_frequencies.to("Hz").magnitude[1:]
    text = ", ".join(f"{f:.2f}" for f in frequencies[:3]) + f" and {frequencies[3]:.2f} Hz"
    assert f"Both give {text}" in page


@pytest.mark.parametrize("cls", list(built_in()), ids=lambda cls: f"{cls.id}_v{cls.version}")
def test_the_page_of_a_template_is_complete(cls):
    page = templates.page(cls)
    for name in cls.inputs:
        assert f'id="in-{name}"' in page
    for name in cls.formulas:
        assert f'id="out-{name}"' in page
    assert page.count("<math") >= len(cls.formulas)
    for level in cls.levels:
        assert f"<code>{level}</code>" in page
    example = eval(re.search(r"example = (\{.*?^\})", page, re.MULTILINE | re.DOTALL)[1])
    assert example == json.loads(json.dumps(dict(cls.example)))


def test_the_page_of_the_criteria_has_every_criterion_and_its_source():
    page = dict(criteria.pages())["reference/criteria.md"]
    for cls in built_in():
        for one in cls.declared_criteria:
            assert f"<td><code>{one.name}</code><br>{escape(one.words)}</td>" in page
            assert f"<code>{escape(one.require)}</code>" in page
            assert one.source is None or str(escape(one.source)) in page
            assert one.unverified is None or f"no: {escape(one.unverified)}" in page
            assert all(f"<code>{limit.name}</code>" in page for limit in one.limits)
    assert page.count("<th>verified</th>") == sum(bool(cls.declared_criteria) for cls in built_in())
    assert "</table>\n##" not in page  # Markdown ends a block of HTML at an empty line


def test_the_page_of_a_template_has_its_criteria():
    page = templates.page(get("oil_film", 2).template)
    assert "<code>film_below_roughness</code>" in page
    assert "or by a row of <code>bearing_material</code>" in page


def test_the_page_of_the_library_has_every_row():
    page = dict(criteria.pages())["reference/library.md"]
    for table in tables().values():
        for row in table.rows:
            assert f'id="{table.id}-{row.id}"' in page
            assert str(escape(row.source)) in page


def test_the_page_of_a_template_shows_the_results_of_its_example():
    cls = get("oil_film", 2).template
    film = get("oil_film", 2)(**cls.example)
    row = f"<td><code>minimum_film_thickness</code></td><td>{film.minimum_film_thickness.magnitude:.5g}</td>"
    assert row in templates.page(cls)


def test_the_page_of_a_model_shows_the_dimensions_of_its_file():
    cls = cad_models().get("plain_bearing", 1)
    build = regenerate("plain_bearing", 1, cls.from_quantities(cls.example).inputs_si())
    page = models.page(cls, build)
    for name in cls.inputs:
        row = re.search(rf'<tr id="in-{name}">.*?</tr>', page, re.DOTALL)[0]
        if name in build.dimensions:
            assert f"<td>{build.dimensions[name]:.5g}</td>" in row


def test_the_rest_reference_lists_every_call_and_every_schema():
    document = rest.interface()
    page = rest.page(document)
    for path, item in document["paths"].items():
        for method, operation in item.items():
            assert f"### {operation['summary']}\n\n`{method.upper()} {path}`\n" in page
    anchors = set(re.findall(r"\{: #(schema-\S+) \}", page))
    assert anchors == {f"schema-{name.lower()}" for name in document["components"]["schemas"]}
    assert set(re.findall(r'href="#(schema-[^"]+)"', page)) <= anchors


def test_the_map_names_every_module_and_says_what_it_is():
    listed = list(map_of_code.packages())
    files = {path for top in map_of_code.PACKAGES for path in (ROOT / top).rglob("*.py")}
    named = {ROOT / package / f"{name}.py" for package, _, modules in listed for name, _ in modules}
    assert {file for file in files if file.stem not in ("__init__", "__main__")} == named
    assert [package for package, text, _ in listed if not text] == []


def test_the_index_has_every_decision():
    rows = [decisions.row(path) for path in decisions.files()]
    assert len(rows) == len(list((ROOT / "docs" / "decisions").glob("*.md")))
    for row in rows:
        assert re.fullmatch(
            r"\| \d{3} \| \[[^]\da-z][^]]+\]\(\d{3}-[\w-]+\.md\) \| [^#\s].*[^ ] \|\n", row
        ), row


def test_the_references_have_every_declaration_and_method():
    pages = dict(client.pages()) | dict(language.pages())
    for name in language.DECLARATIONS:
        assert f"### {name}\n" in pages["reference/language.md"]
    assert "### create\n" in pages["reference/client.md"]
    assert "## get\n" in pages["reference/door.md"]


def example(self, one: int, *, two: str = "a, b", three: dict[str, int] | None = None) -> str:
    """Return something.

    Parameters
    ----------
    one
        The first one,
        at length.
    two
        The second.

    Raises
    ------
    ValueError
        If not.
    """


def test_a_signature_and_its_docstring_become_markdown():
    assert signature("example", example) == (
        'example(one: int, *, two: str = "a, b", three: dict[str, int] | None = None) -> str'
    )
    assert prose(example) == (
        "Return something.\n\n**Parameters**\n\n- `one`: The first one, at length.\n- `two`: The second.\n\n"
        "**Raises**\n\n- `ValueError`: If not.\n"
    )
