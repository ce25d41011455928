"""The structure of `app`, as `benchmarks.structure` counts it."""

from pathlib import Path

from benchmarks.structure import (
    REASONS,
    arrows,
    circles,
    graph,
    named,
    pairs,
    participles,
    single_importers,
    upward,
    words,
)

VAGUE = frozenset({"told", "found", "known", "made", "dear", "anew", "mend"})
"""Participles that say how a value came about, and not what it is."""

MOST_ANY = 39  # each with its reason; there were 513
MOST_JSON = 378  # values of any shape that a model, a migration or a schema checks as a whole


def test_no_import_points_against_the_layers():
    counted = arrows()
    assert counted.total() > 300
    assert upward(counted) == []


def test_no_modules_import_each_other():
    assert circles(graph()) == []


def test_a_short_module_with_one_importer_has_its_reason():
    short = single_importers(graph())
    assert sorted(short.keys() - REASONS.keys()) == []


def test_what_is_typed_as_any_does_not_grow():
    assert 0 < words("Any").total() <= MOST_ANY
    assert 0 < words("Json|JsonObject").total() <= MOST_JSON


def test_words_are_counted_whole(tmp_path):
    (tmp_path / "some.py").write_text("Any, Anything: list[Any]  # Many, Any\n", encoding="utf-8")
    assert words("Any", tmp_path) == {"some.py": 3}


def test_names_say_what_a_value_is():
    assert named(VAGUE) == {"storage/tables/solids.py": 1}  # the column of every database since 0.1


def test_vague_names_are_counted_wherever_they_are_given(tmp_path):
    text = "def made(found): known = found\nclass Told: _anew = 1\nit.mend = 2\nprint(told, known=1)\n"
    (tmp_path / "some.py").write_text(text, encoding="utf-8")
    assert named(VAGUE, tmp_path) == {"some.py": 6}


def test_a_folder_of_physics_has_at_most_15_files():
    folders = [folder for folder in Path("templates/physics").iterdir() if (folder / "__init__.py").exists()]
    assert len(folders) > 10
    counts = {folder.name: len(list(folder.glob("*.py"))) - 1 for folder in folders}
    assert {name: count for name, count in counts.items() if count > 15} == {}


def program(tmp_path, files):
    for name, text in files.items():
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    return tmp_path


def test_modules_that_import_each_other_are_a_circle(tmp_path):
    root = program(
        tmp_path,
        {
            "app/one.py": "from app.inner import two\n",
            "app/inner/two.py": "def later():\n    from app.three import something\n",
            "app/three.py": "import app.one\n",
            "app/four.py": "from app.three import something\n",
        },
    )
    assert circles(graph(root)) == [["app.inner.two", "app.one", "app.three"]]


def test_a_short_module_with_one_importer_is_listed(tmp_path):
    root = program(
        tmp_path,
        {
            "app/user.py": "from app import short, long, both\nfrom app.x import routes\n",
            "app/other.py": "from app import both\n",
            "app/short.py": "a = 1\n",
            "app/long.py": "b = 1\n" * 60,
            "app/both.py": "c = 1\n",
            "app/x/routes.py": "d = 1\n",
        },
    )
    assert single_importers(graph(root), root) == {"app.short": "app.user"}


def test_names_that_differ_by_an_ending_are_listed(tmp_path):
    names = ("explain", "explained", "report", "preview", "previewing")
    root = program(tmp_path, {f"app/room/{name}.py": "" for name in names})
    assert pairs(root) == [("app/room", "explain, explained"), ("app/room", "preview, previewing")]
    assert participles(root) == ["app/room/explained.py", "app/room/previewing.py"]
