"""Whatever a template reads by a string is a dependency that the language sees."""

import ast
import inspect
from itertools import chain
from pathlib import Path

import numpy as np
import pytest

import templates
from cad.catalogue import models
from cad.model import CadModel
from templates.core.catalogue.discovery import find
from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.core.language.template import Template, derived, formula, given, require, shared

BUILT_IN = [*chain(find([Path(templates.__file__).parent], Template), models())]


class Spring(Template):
    """A spring whose stiffness is given, or follows."""

    example = {"force": "1 N"}
    F = given("N", "force")
    G = given("Pa", "shear modulus", default="80 GPa")
    d = given("mm", "wire", default="1 mm")

    @derived("N/m", "stiffness", gt=0)
    def k(self):
        return self.G * self.d

    @shared
    def stiffness_is_given(self):
        return self.as_given("k") > 0

    @formula("1", "known")
    def known(self):
        return 1.0 * self.stiffness_is_given

    @formula("N", "same force")
    def same(self):
        return getattr(self, "F")  # noqa: B009

    @require("force", remedy="give the stiffness")
    def needs_stiffness(self):
        """A force above 5 N needs the stiffness."""
        return (self.F < 5) | (self.as_given("k") > 0)


def test_property_a_value_read_as_given_is_a_dependency_but_its_formula_is_not():
    assert Spring.intermediates["stiffness_is_given"].uses_as_given == ("k",)
    assert Spring.dependencies("known") - Spring.ancestors("known") == {"k"}
    assert Spring.ancestors("known").isdisjoint({"k", "G", "d"})
    assert Spring.ancestors("k") == Spring.dependencies("k") == {"k", "G", "d"}


def test_property_getattr_with_a_literal_is_a_dependency():
    assert "F" in Spring.ancestors("same")


def test_property_a_rule_waits_for_a_pending_input_that_it_reads_as_given():
    Spring.from_quantities({"force": "8 N"}, pending=["stiffness"])
    Spring.from_quantities({"force": "8 N", "stiffness": "1 N/m"})
    with pytest.raises(InvalidInputs, match="needs the stiffness"):
        Spring.from_quantities({"force": "8 N"}, pending=["wire"])


def test_property_a_refused_point_of_an_input_read_as_given_has_no_result():
    """Else the film temperature would be that of the oil which stands in for the refused viscosity."""
    film = find([Path(templates.__file__).parent], Template).get("oil_film", 2)
    given = {name: value for name, value in film.example.items() if "temperature" not in name}
    given |= {"supply_temperature": "40 degC", "dynamic_viscosity": {"value": [10, -1], "unit": "mPa*s"}}
    answer = evaluate(film, given, outputs=["film_temperature", "outlet_temperature"])
    for output in answer.outputs.values():
        assert np.isfinite(output.value[0])
        assert np.isnan(output.value[1])
        assert "dynamic_viscosity must be" in output.reasons[1]


def files_of(cls):
    """The file of a version, and those of its groups; not those of the language."""
    of_language = {inspect.getfile(Template), inspect.getfile(CadModel)}
    return {inspect.getfile(base) for base in cls.__mro__ if issubclass(base, Template)} - of_language


def reads_by_string(function):
    """Every node in a method that reads an attribute of the template by a string, with the name, or None."""
    for node in ast.walk(function):
        match node:
            case ast.Call(func=ast.Attribute(value=ast.Name(id="self"), attr="as_given"), args=[name]):
                yield literal(name)
            case ast.Call(func=ast.Name(id="getattr" | "attrgetter" | "hasattr"), args=[*_, name]):
                yield literal(name)
            case ast.Call(func=ast.Name(id="vars"), args=[ast.Name(id="self")]):
                yield None
            case ast.Attribute(value=ast.Name(id="self"), attr="__dict__" | "__getattribute__"):
                yield None


def literal(node):
    return node.value if isinstance(node, ast.Constant) and isinstance(node.value, str) else None


def methods(cls):
    """The methods in the files of a version and its groups; a group's file may hold more than it inherits."""
    inherited = {base.__name__ for base in cls.__mro__}
    for file in sorted(files_of(cls)):
        for group in ast.parse(Path(file).read_text(encoding="utf-8")).body:
            if isinstance(group, ast.ClassDef) and group.name in inherited:
                yield from (node for node in ast.walk(group) if isinstance(node, ast.FunctionDef))


def seen_of(cls, method):
    """The dependencies that the language records for a method of a template."""
    node = cls.__dict__.get(method) or next(
        vars(base)[method] for base in cls.__mro__ if method in vars(base)
    )
    return {*node.uses, *node.uses_as_given}


@pytest.mark.parametrize("cls", BUILT_IN, ids=lambda cls: f"{cls.id}-{cls.version}")
def test_property_no_template_reads_an_attribute_unseen(cls):
    for method in methods(cls):
        for name in reads_by_string(method):
            assert name, f"{method.name} reads an attribute by a name that is not a literal"
            assert name in cls.declarations, f"{method.name} reads {name}, which is not an input"
            assert name in seen_of(cls, method.name)
            if method.name in cls.declarations:
                assert name in cls.dependencies(method.name)


def test_property_the_templates_that_read_by_a_string_are_those_known():
    """The walk finds what stands in the files; without this, a broken walk would pass."""
    names = {
        cls.id + str(cls.version): {n for m in methods(cls) for n in reads_by_string(m)} for cls in BUILT_IN
    }
    assert {name: read for name, read in names.items() if read} == {
        "oil_film2": {"eta", "a_V", "b_V"},
        "stress_life1": {"sigma_a", "sigma_m", "K_t"},
        "cycle_heat_balance1": {"eta", "a_V", "b_V"},
        "elastic_film1": {"a_V", "b_V"},
        "mixed_friction1": {"a_V", "b_V"},
        "thermal_film1": {"eta", "a_V", "b_V"},
        "thrust_bearing1": {"eta", "a_V", "b_V"},
    }
