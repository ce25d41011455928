"""The catalogue, digests and golden records, on test templates; errors that cross a process."""

import json
import pickle
from pathlib import Path

import pytest

import templates
from templates.core.catalogue.digests import digest
from templates.core.catalogue.discovery import find
from templates.core.catalogue.golden import freeze, golden_file, record
from templates.core.errors import Fault, FaultyText, InvalidInputs, UnknownTemplate, Unreachable, UnusableFile
from templates.core.language.evaluate import evaluate
from templates.core.language.template import Template

SOURCE = '''"""A team's own template."""

from templates.core.language.template import Template, choice, derived, formula, given


class Own(Template):
    """Twice a length."""

    withdrawn = None
    example = {"length": "2 m"}

    a = given("m", "length", gt=0, le=2)
    n = given("1", "count", default=2, integer=True)
    way = choice("up", "down", words="way", default="up")

    @derived("m", "width")
    def b(self):
        return self.a

    @formula("m", "twice the length")
    def r(self):
        """Doubled."""
        return 2 * self.a + 0 * self.b * self.n
'''


def written(folder, name="own_v1", source=SOURCE):
    folder.mkdir(exist_ok=True)
    path = folder / f"{name}.py"
    path.write_text(source, encoding="utf-8")
    return folder


def only(folder):
    (cls,) = find([folder], Template)
    return cls


class TestFinding:
    def test_property_own_folder_stands_beside_the_built_in_ones(self, tmp_path):
        catalogue = find([Path(templates.__file__).parent, written(tmp_path / "own")], Template)
        assert {"oil_film", "own"} <= set(catalogue.ids)
        own = catalogue.get("own", 1)
        assert (own.id, own.version) == ("own", 1)
        assert evaluate(own, own.example).outputs["twice_the_length"].value == 4

    def test_property_equal_file_names_in_two_folders_are_kept_apart(self, tmp_path):
        one = only(written(tmp_path / "one"))
        other = only(written(tmp_path / "other", source=SOURCE.replace("2 * self.a", "3 * self.a")))
        results = [evaluate(cls, cls.example).outputs["twice_the_length"].value for cls in (one, other)]
        assert results == [4, 6]
        assert digest(one) != digest(other)
        with pytest.raises(UnusableFile, match="already declared in another file"):
            find([tmp_path], Template)

    def test_property_latest_is_the_newest_that_is_not_withdrawn(self, tmp_path):
        for version, mark in ((1, "None"), (2, "None"), (10, '"wrong, use 2"')):
            source = SOURCE.replace("withdrawn = None", f"withdrawn = {mark}")
            written(tmp_path / "own", f"own_v{version}", source)
        catalogue = find([tmp_path / "own"], Template)
        assert list(catalogue.of("own")) == [1, 2, 10]
        assert catalogue.latest("own").version == 2
        assert catalogue.get("own", 10).withdrawn

    def test_property_unknown_ids_and_versions_say_what_there_is(self, tmp_path):
        catalogue = find([written(tmp_path / "own")], Template, "model")
        with pytest.raises(UnknownTemplate, match="no model is named 'owl'; use one of own"):
            catalogue.latest("owl")
        with pytest.raises(UnknownTemplate, match="model own has no version 7; its versions are 1"):
            catalogue.get("own", 7)

    @pytest.mark.parametrize("source", ["x = 1", SOURCE + "\n\nclass Second(Own):\n    '''Two.'''\n"])
    def test_property_a_file_declares_one(self, tmp_path, source):
        with pytest.raises(UnusableFile, match="must declare one"):
            find([written(tmp_path / "own", source=source)], Template)

    def test_property_a_broken_file_is_not_remembered(self, tmp_path):
        folder = written(tmp_path / "own", source="1 / 0")
        for _ in range(2):
            with pytest.raises(UnusableFile, match=r"own_v1\.py: line 1: ZeroDivisionError"):
                find([folder], Template)

    def test_property_other_files_are_left_alone(self, tmp_path):
        for name in ("own_v0", "own_vx", "Own_v1", "own_v1_old"):
            written(tmp_path / "own", name, "1 / 0")
        assert list(find([tmp_path / "own"], Template)) == []


class TestFreezing:
    def test_golden_is_written_once(self, tmp_path):
        own = only(written(tmp_path / "own"))
        path = freeze(own, tmp_path / "golden")
        assert path == golden_file(own, tmp_path / "golden") == tmp_path / "golden" / "own_v1.json"
        assert json.loads((tmp_path / "own" / "own_v1.release.json").read_text()) == {"digest": digest(own)}
        before = path.read_bytes()
        with pytest.raises(FileExistsError):
            freeze(own, tmp_path / "golden")
        assert path.read_bytes() == before

    def test_golden_record_steps_every_input(self, tmp_path):
        frozen = record(only(written(tmp_path / "own")))
        assert (frozen["id"], frozen["version"], frozen["precision"]) == ("own", 1, 1e-12)
        cases = [(case["inputs"], case.get("outputs", case.get("refused"))) for case in frozen["cases"]]
        example = {"length": 2, "count": 2, "way": "up", "width": 2}
        assert cases[0] == (example, {"twice_the_length": 4})
        assert ({**example, "length": 1.8}, {"twice_the_length": 3.6}) in cases
        assert ({**example, "length": 2.2}, ["out_of_range"]) in cases
        assert ({**example, "count": 3}, {"twice_the_length": 4}) in cases
        assert ({**example, "way": "down"}, {"twice_the_length": 4}) in cases
        assert len(cases) == 1 + 2 + 2 + 1 + 2

    def test_golden_record_holds_further_cases(self, tmp_path):
        """Those in the folder's `more`: the example but for the inputs named, as users give them."""
        own = only(written(tmp_path / "own"))
        more = tmp_path / "golden" / "more" / "own_v1.json"
        more.parent.mkdir(parents=True)
        more.write_text(json.dumps([{"level": "", "inputs": {"length": "1500 mm"}}]))
        frozen = json.loads(freeze(own, tmp_path / "golden").read_text())
        (case,) = frozen["levels"]
        assert (case["inputs"]["length"], case["outputs"]) == (1.5, {"twice_the_length": 3})


@pytest.mark.parametrize(
    "error",
    [
        InvalidInputs([Fault("speed", "missing", "speed is needed")]),
        UnknownTemplate("own", "there is no own"),
        Unreachable("width", "out of reach", (1.0, 2.0), "mm"),
        FaultyText("syntax", "not understood"),
    ],
    ids=lambda error: type(error).__name__,
)
def test_property_errors_come_whole_out_of_another_process(error):
    again = pickle.loads(pickle.dumps(error))
    assert (type(again), str(again), vars(again)) == (type(error), str(error), vars(error))


GROUP = '''"""A group."""

from templates.core.language.template import Template, given, require


class Sized(Template):
    """A length."""

    a = given("m", "length", gt=0, le={most})

    @require("length", remedy="take another")
    def whole(self):
        """The length is real."""
        return self.a == self.a
'''
MEMBER = '''"""A member."""

import {group}
from templates.core.language.template import formula


class Member({group}.Sized):
    """Twice a length."""

    example = {{"length": "2 m"}}

    @formula("m", "twice the length")
    def r(self):
        """Doubled."""
        return 2 * self.a
'''


class TestGroups:
    def member(self, folder, monkeypatch, group, most):
        folder.mkdir()
        monkeypatch.syspath_prepend(str(folder))
        (folder / f"{group}.py").write_text(GROUP.format(most=most), encoding="utf-8")
        return only(written(folder, "member_v1", MEMBER.format(group=group)))

    def test_golden_digest_covers_the_file_of_a_group(self, tmp_path, monkeypatch):
        """The member's own file differs by the name of its group alone."""
        one = self.member(tmp_path / "one", monkeypatch, "group_one", 2)
        two = self.member(tmp_path / "two", monkeypatch, "group_two", 3)
        bare = {digest(cls) for cls in (one, two)}
        monkeypatch.setattr(one.__mro__[1], "__module__", two.__mro__[1].__module__)
        assert digest(one) not in bare
        assert list(one.inputs) == ["length"]
        assert evaluate(one, one.example).outputs["twice_the_length"].value == 4
