"""Random expressions give equal results at one point and at many, as trees, closures and NumPy."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from types import SimpleNamespace

import lark
import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from seeds import examples

from templates.core.errors import FaultyText
from templates.core.paper.expressions import latex, relation_latex
from templates.core.paper.mathml import mathml
from templates.core.units.closures import closure
from templates.core.units.expressions import GRAMMAR, Sort, checked
from templates.core.units.operations import Kind, Name
from templates.core.units.relation import parse
from templates.core.units.units import unit

PARSER = lark.Lark(GRAMMAR, parser="lalr", propagate_positions=True)
METRE = Kind(unit("m").base)
SORTS = {
    "a": Sort(),
    "b": Sort(),
    "d": Sort(METRE),
    "w": Sort(METRE),
    "v": Sort(axis="place"),
    "law": Sort(words=("walther", "vogel")),
}
COMPARED = {"<": np.less, "<=": np.less_equal, ">": np.greater, ">=": np.greater_equal, "!=": np.not_equal}
COMBINED = {"+": np.add, "-": np.subtract, "*": np.multiply}


class Scope:
    """The names of `SORTS`."""

    def name(self, text):
        if text not in SORTS:
            raise FaultyText("unknown_name", "not declared")
        return Name(text), SORTS[text]

    def function(self, name):
        return None

    def spend(self):
        pass


def plain(text, value):
    return text, lambda names: value


def named(name):
    return name, lambda names: names[name]


def both(pattern, calculate, *parts):
    """A text from those of its parts, and how NumPy calculates it from their values."""
    texts, values = zip(*parts, strict=True)
    return pattern.format(*texts), lambda names: calculate(*(value(names) for value in values))


def chosen(condition, one, other):
    return np.where(condition, one, other)


def conditions(numbers, lengths):
    """Comparisons, joined."""
    compared = st.builds(
        lambda sign, pair: both(f"{{}} {sign} {{}}", COMPARED[sign], *pair),
        st.sampled_from(sorted(COMPARED)),
        st.tuples(numbers, numbers) | st.tuples(lengths, lengths),
    )
    chained = st.builds(
        lambda x, y, z: both("{} < {} <= {}", lambda p, q, r: (p < q) & (q <= r), x, y, z),
        lengths,
        lengths,
        lengths,
    )
    tested = st.sampled_from([plain("law is walther", True), plain("law is vogel", False)])
    leaf = compared | chained | tested
    return st.recursive(
        leaf,
        lambda inner: (
            st.builds(lambda x, y: both("({} and {})", np.logical_and, x, y), inner, inner)
            | st.builds(lambda x, y: both("({} or {})", np.logical_or, x, y), inner, inner)
            | st.builds(lambda x: both("(not {})", np.logical_not, x), inner)
        ),
        max_leaves=3,
    )


def grown(leaves, other):
    """Sums and decisions of values of one kind."""
    return st.recursive(
        leaves,
        lambda inner: (
            st.builds(
                lambda s, x, y: both(f"({{}} {s} {{}})", COMBINED[s], x, y),
                st.sampled_from("+-"),
                inner,
                inner,
            )
            | st.builds(lambda x, y: both("max({}, {})", np.maximum, x, y), inner, inner)
            | st.builds(lambda x, y: both("[{}, {}][2]", lambda p, q: q + 0 * p, x, y), inner, inner)
            | st.builds(lambda x, y: both("sum([{}, {}])", np.add, x, y), inner, inner)
            | st.builds(
                lambda c, x, y: both("(if {} then {} else {})", chosen, c, x, y),
                conditions(other, other),
                inner,
                inner,
            )
        ),
        max_leaves=6,
    )


lengths = st.sampled_from([named("d"), named("w"), plain("3 mm", 3e-3), plain("-0.5 m", -0.5)])
simple = st.sampled_from([named("a"), named("b"), plain("2.5", 2.5), plain("-1", -1.0), plain("pi", np.pi)])
numbers = grown(simple, simple) | st.builds(
    lambda x, y: both("{} * {}", np.multiply, x, y), grown(simple, simple), simple
)
listed = st.builds(
    lambda x, y: both("mean({} * v - {})", lambda p, q: np.mean(p, axis=-1), x, y), simple, simple
)
expressions = numbers | grown(lengths, simple)
values = st.floats(-10, 10).map(lambda x: round(x, 3))


@st.composite
def points(draw):
    """Three points of every name, and what one of them is."""
    columns = {name: np.array([draw(values) for _ in range(3)]) for name in ("a", "b", "d", "w")}
    columns["v"] = np.array([[draw(values) for _ in range(4)] for _ in range(3)])
    return columns


def of_point(columns, row):
    return {name: column[row] if column.ndim > 1 else float(column[row]) for name, column in columns.items()}


@settings(max_examples=examples(150), deadline=None)
@given(expressions, points())
def test_property_one_point_as_many_closures_as_trees_and_as_numpy(expression, columns):
    text, numpy = expression
    node, sort = checked(PARSER.parse(text), Scope())
    run, relation = closure(node), parse(f"= {text}").decided({"law": "walther"})
    many = np.broadcast_to(run(SimpleNamespace(**columns, law="walther")), (3,))
    np.testing.assert_allclose(many, np.broadcast_to(numpy(columns), (3,)), rtol=1e-12, atol=1e-12)
    kinds = {name: SORTS[name].kind for name in relation.names}
    assert relation.kind(kinds) == sort.kind
    for row in range(3):
        names = of_point(columns, row)
        one = run(SimpleNamespace(**names, law="walther"))
        assert one == many[row]
        assert relation.value(names) == one
    ElementTree.fromstring(mathml(latex(node, {"a": "3~\\text{mm}"})))


@settings(max_examples=examples(50), deadline=None)
@given(simple, simple, points())
def test_property_single_values_meet_lists_at_each_point(one, other, columns):
    text = f"({one[0]}) * v - (if v > {other[0]} then v else {one[0]})"
    run = closure(checked(PARSER.parse(text), Scope())[0])
    with np.errstate(all="ignore"):
        many = run(SimpleNamespace(**columns))
        for row in range(3):
            names = of_point(columns, row)
            factor, limit, v = one[1](names), other[1](names), names["v"]
            np.testing.assert_allclose(many[row], factor * v - np.where(v > limit, v, factor), atol=1e-12)
            np.testing.assert_array_equal(run(SimpleNamespace(**names)), many[row])


WORDS = (
    "if then else and or not is [ ] ( ) < <= == != , a d v law walther sum( mean( min( max( count( 2 3 mm "
    "1e3 + - * / ** [2] [a]"
)


def attempt(ask, text):
    """Ask; a refusal in words is an answer, any other error fails the test."""
    try:
        ask(text)
    except (FaultyText, lark.exceptions.UnexpectedInput) as error:
        return str(error)
    return "done"


def calculated(text):
    relation = parse(text)
    relation = relation.decided(dict.fromkeys(relation.choices, "walther"))
    relation.kind(dict.fromkeys(relation.names, Kind()))
    result = relation.value(dict.fromkeys(relation.names, 2.0))
    assert np.ndim(result) <= 1
    ElementTree.fromstring(mathml(relation_latex(text) or "1"))


def closed(text):
    node, sort = checked(PARSER.parse(text), Scope())
    assert isinstance(sort, Sort)
    closure(node)
    latex(node, {})


PIECES = st.lists(st.sampled_from([*WORDS.split(), '"SAE"']), max_size=30).map(" ".join)


@settings(max_examples=examples(400), deadline=None)
@given(PIECES | st.text(max_size=60))
def test_property_any_text_is_calculated_or_refused(text):
    assert attempt(calculated, f"= {text}")
    assert attempt(closed, text)
