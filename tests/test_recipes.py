"""The recipes of docs/contributing.md, carried out literally on a copy of the tree.

Blocks are handled in order: a shell block is run, a block with a file name is written, a diff is applied by
`git apply`, and a block of plain text is the expected output of the shell block before it.
"""

import json
import os
import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest
from patience import patient

ROOT = Path(__file__).parents[1]
PAGE = (ROOT / "docs" / "contributing.md").read_text(encoding="utf-8")
OUTPUT, FORMAT = "an additional output, as a new version", "a new file format"
FILTER = "an additional filter on a list"
FIELD, SECTION = "a field of a resource", "a section of a page"
RECIPES = (OUTPUT, FORMAT, FILTER, FIELD, SECTION)
BLOCK = re.compile(r'^```(\w+)(?: title="([^"]+)")?\n(.*?)^```$', re.MULTILINE | re.DOTALL)
LONGEST = patient(240.0)  # one command [s]


@dataclass(frozen=True)
class Block:
    """A fenced block of a recipe."""

    language: str
    file: str
    text: str

    @property
    def is_edit(self):
        """Whether it changes files only, by tools that every machine has."""
        commands = {line.split(" ")[0] for line in self.text.splitlines()}
        return self.language in ("diff", "python", "html") or commands <= {"cd", "cp", "sed"}


def recipe(title):
    """The blocks of a recipe, in their order."""
    section = PAGE.split(f"\n## Recipe: {title}\n")[1].split("\n## ")[0]
    return [Block(language, file, text) for language, file, text in BLOCK.findall(section)]


def run(command, copy, **options):
    """What a command prints in the copy, whose packages it imports."""
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    inherited = {name: text for name, text in os.environ.items() if not name.startswith(("PYTEST_", "COV_"))}
    done = subprocess.run(
        command,
        cwd=copy,
        env={**inherited, "PATH": path, "PYTHONPATH": str(copy)},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=LONGEST,
        **options,
    )
    assert done.returncode == 0, f"{command}\n{done.stdout[-4000:]}"
    return done.stdout


def carry_out(blocks, copy):
    """Do what the blocks say; return what the shell blocks print."""
    printed = [""]
    for block in blocks:
        if block.language == "sh":
            printed.append(run(["bash", "-e", "-c", block.text], copy))
        elif block.language == "diff":
            run(["git", "apply", "-"], copy, input=block.text)
        elif block.language == "text":
            assert block.text in printed[-1]
        else:
            with (copy / block.file).open("x", encoding="utf-8") as file:
                file.write(block.text)
    return printed[1:]


def count_passed(printed):
    """How many tests the last pytest run reports as passed, with none that failed or was skipped."""
    summary = printed.strip().splitlines()[-1]
    assert not re.search("failed|error|skipped", summary), summary
    return int(re.search(r"(\d+) passed", summary)[1])


def program_files(blocks):
    """Return the files of the program that a recipe changes or writes, without its tests."""
    text = "\n".join(block.text for block in blocks if block.language == "diff")
    files = {*re.findall("^--- a/(.*)$", text, re.MULTILINE), *(block.file for block in blocks if block.file)}
    return {file for file in files if not file.startswith("tests/")}


def going_through_templates(copy):
    """Return the test files that go through all templates, but those of a server and this one."""
    files = [*(copy / "tests").glob("test_handbook.py"), *(copy / "tests" / "templates").rglob("test_*.py")]
    return [str(file) for file in files if "built_in()" in file.read_text(encoding="utf-8")]


@pytest.fixture
def copy(tmp_path):
    """The files that git knows or would add, in a folder of their own."""
    command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    listed = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    for name in filter(None, listed.split("\0")):
        if (ROOT / name).is_file():
            (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / name).write_bytes((ROOT / name).read_bytes())
    return tmp_path


def test_the_page_has_these_recipes():
    assert tuple(re.findall(r"^## Recipe: (.*)$", PAGE, re.MULTILINE)) == RECIPES
    assert all({"sh", "diff", "python"} <= {block.language for block in recipe(title)} for title in RECIPES)


def test_the_edits_of_every_recipe_fit_the_tree_and_pass_the_linter(copy):
    for title in RECIPES:
        carry_out([block for block in recipe(title) if block.is_edit], copy)
    run(["ruff", "check", "--no-cache"], copy)
    run(["ruff", "format", "--check", "--no-cache"], copy)


@pytest.mark.slow
def test_one_more_output_is_a_new_version(copy):
    def digest(version):
        page = run(["crankwright", "template", "show", "journal_friction", "--version", str(version)], copy)
        return re.search(r"digest (\w{12})", page)[1]

    before = digest(1)
    *_, tests = carry_out(recipe(OUTPUT), copy)
    assert count_passed(tests) > 40  # of both versions
    assert count_passed(run(["pytest", "-n", "2", "-q", *going_through_templates(copy)], copy)) > 100
    assert "journal_friction-2" in run(
        ["pytest", "--collect-only", "-q", "tests/templates/test_catalogue_properties.py"], copy
    )
    record = json.loads((copy / "tests" / "golden" / "journal_friction_v2.json").read_text())
    assert digest(1) == before != digest(2) == record["digest"][:12]
    released = "templates/oil_film/journal_friction_v1.release.json"
    assert (copy / released).read_bytes() == (ROOT / released).read_bytes()


@pytest.mark.slow
def test_a_new_file_format_is_served(copy):
    *_, tests = carry_out(recipe(FORMAT), copy)
    assert count_passed(tests) > 10
    assert "`.obj`" in (copy / "docs" / "howto" / "designs.md").read_text(encoding="utf-8")


@pytest.mark.slow
def test_a_list_has_one_more_filter(copy):
    *_, tests = carry_out(recipe(FILTER), copy)
    assert count_passed(tests) > 20
    script = "import sys; sys.path.append('docs'); from handbook.rest import interface; "
    script += "print(interface()['paths']['/api/v1/designs']['get'])"
    assert "changed_since" in run([sys.executable, "-c", script], copy)


def test_a_field_takes_four_files_and_a_section_three():
    assert len(program_files(recipe(FIELD))) == 4
    assert len(program_files(recipe(SECTION))) == 3


@pytest.mark.slow
def test_a_comment_has_one_more_field(copy):
    *_, tests = carry_out(recipe(FIELD), copy)
    assert count_passed(tests) > 40


@pytest.mark.slow
def test_a_page_has_one_more_section(copy):
    *_, tests = carry_out(recipe(SECTION), copy)
    assert count_passed(tests) > 5
