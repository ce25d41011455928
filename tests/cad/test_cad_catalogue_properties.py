"""Properties that every CAD model must have; models are found by file, see conftest."""

import hashlib
import json
import math
import os
from typing import Any

import numpy as np
import pytest
from forked import Forked
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from netgen.occ import OCCGeometry
from patience import patient
from slow_models import BALLS, DRAWN, LARGE, quick_for, slow_for

from cad.catalogue import models
from cad.checks import check_box
from cad.errors import GeometryError
from cad.header import read_header
from cad.inspect import MEASURES
from cad.model import CadModel
from cad.regenerate import Build, Value, as_text, build_key, regenerate
from templates.core.errors import InvalidInputs
from templates.core.language.spec import Choice, Curve, Derived

HOSTILE = [math.nan, math.inf, -math.inf, -1.0, 1e12]
SIGNED = {("crankshaft", 1): {"pin_split"}}
"""Numbers that may be negative."""
UNSEEN = {("plain_bearing", 1): {"free_spread", "reduction_height"}}
"""Numbers that the solid of the example does not show; test_free_shell.py reads the spread of free shells. No
face is at the height at which test_eccentric_bore.py measures a wall."""


def test_example_builds_and_shows_its_parameters(model: type[CadModel], example: Build) -> None:
    asked = model.from_quantities(model.example)
    for name, result in example.dimensions.items():
        declared = model.inputs[name]
        wanted = np.asarray(declared.meaning.scale.from_si(getattr(asked, declared.attribute)))
        assert result == pytest.approx(np.broadcast_to(wanted, np.shape(result)).tolist(), abs=1e-6), name


def test_every_number_is_read_back(model: type[CadModel], example: Build) -> None:
    numbers = {name for name, declared in model.inputs.items() if not isinstance(declared, Choice)}
    assert set(example.dimensions) == numbers - UNSEEN.get((model.id, model.version), set())


def test_every_measure_is_a_finite_number(example: Build) -> None:
    assert set(example.measures) == set(MEASURES)
    assert all(type(value) is float and math.isfinite(value) for value in example.measures.values())


def test_volume_is_that_of_the_closed_form(model: type[CadModel], example: Build) -> None:
    parts = model.from_quantities(model.example).build()
    wanted = sum(part.volume * len(part.places) for part in parts)
    assert example.measures["volume"] == pytest.approx(wanted, rel=1e-6)


def test_inertia_could_be_that_of_a_body(example: Build) -> None:
    xx, yy, zz = (example.measures[f"inertia_{axes}"] for axes in ("xx", "yy", "zz"))
    assert min(xx, yy, zz) > 0
    assert max(xx, yy, zz) <= (xx + yy + zz) / 2


def test_second_kernel_finds_the_same_volume(
    example: Build, tmp_path_factory: pytest.TempPathFactory
) -> None:
    file = tmp_path_factory.mktemp("netgen") / "model.step"
    file.write_bytes(example.step)
    solids = OCCGeometry(str(file)).shape.solids
    assert sum(solid.mass for solid in solids) == pytest.approx(example.measures["volume"], rel=1e-6)


def test_file_says_what_it_is(model: type[CadModel], example: Build) -> None:
    header = read_header(example.step)
    asked = model.from_quantities(model.example)
    assert header is not None
    assert (header.model, header.version) == (model.id, model.version)
    assert header.parameters == as_text(asked)
    assert header.build == example.key == build_key(asked)


@slow_for(("crankshaft", 1))
def test_model_is_made_again_from_the_text_in_its_file(model: type[CadModel], example: Build) -> None:
    header = read_header(example.step)
    assert header is not None
    again = model.from_quantities(header.parameters).inputs_si()
    assert regenerate(header.model, header.version, again) == example


@pytest.fixture(scope="session")
def elsewhere(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """The hashes of the examples of all models that the next test takes, built in another process."""
    name = test_bytes_are_the_same_in_another_process.__name__
    chosen = {
        i.callspec.params["model"] for i in request.session.items if getattr(i, "originalname", "") == name
    }
    classes = [cls for cls in models() if cls in chosen]
    examples = (cls.from_quantities(cls.example).inputs_si() for cls in classes)
    given = [{name: np.asarray(value).tolist() for name, value in one.items()} for one in examples]
    builds = [[cls.id, cls.version, one] for cls, one in zip(classes, given, strict=True)]
    asked, answer, log = (tmp_path_factory.mktemp("elsewhere") / name for name in ("asked", "answer", "log"))
    asked.write_text(json.dumps(builds))
    process = Forked([asked, answer], dict(os.environ), log, call="another_process:write_digests")
    assert process.wait(patient(200)) == 0, log.read_text()
    digests = json.loads(answer.read_text())
    return dict(zip((f"{cls.id}_v{cls.version}" for cls in classes), digests, strict=True))


@quick_for(*DRAWN)
def test_bytes_are_the_same_in_another_process(
    model: type[CadModel], example: Build, elsewhere: dict[str, str]
) -> None:
    assert elsewhere[f"{model.id}_v{model.version}"] == hashlib.sha256(example.step).hexdigest()


@quick_for(("connecting_rod", 1), ("plain_bearing", 1), ("thrust_washer", 1))
def test_bytes_are_the_same_each_time(model: type[CadModel], example: Build) -> None:
    # Six times: the order of three colours was once that of memory addresses, so two equal files were luck.
    colours = {part.colour for part in model.from_quantities(model.example).build()}
    for _ in range(6 if len(colours) > 1 else 1):
        assert regenerate(model.id, model.version, example.parameters).step == example.step


def test_noise_in_the_last_digit_is_the_same_build(model: type[CadModel], example: Build) -> None:
    lengths = {n: v for n, v in example.parameters.items() if model.inputs[n].meaning.unit == "mm"}
    noisy = {n: (np.asarray(length) * (1 + 4e-16)).tolist() for n, length in lengths.items()}
    noisy = {**example.parameters, **noisy}
    assert build_key(model.from_si(noisy)) == example.key


@pytest.mark.parametrize("value", HOSTILE)
def test_hostile_numbers_are_refused_by_name(model: type[CadModel], example: Build, value: float) -> None:
    for name, declared in model.inputs.items():
        may_be = value == -1.0 and name in SIGNED.get((model.id, model.version), ())
        if isinstance(declared, Choice) or may_be:
            continue
        with pytest.raises(InvalidInputs) as refused:
            model.from_si({**example.parameters, name: value})
        assert name in {fault.name for fault in refused.value.faults}


@slow_for(*LARGE, BALLS, ("plain_bearing", 1))
def test_required_parameter_may_have_any_size_in_range(model: type[CadModel]) -> None:
    for share in (0.0, 0.25, 0.5, 0.75, 1.0):
        required = {n: _between(d, share) for n, d in model.inputs.items() if d.required}
        build = regenerate(model.id, model.version, required)
        assert set(build.parameters) == set(model.inputs)


def test_wrong_box_is_noticed(model: type[CadModel], example: Build) -> None:
    asked = model.from_quantities(model.example)
    box = asked.bounding_box()
    with pytest.raises(GeometryError) as refused:
        check_box(asked, type(box)(box.low, (box.high[0] + 1e-3, *box.high[1:])))
    assert refused.value.code == "bounding_box"


def _between(declared: Any, share: float) -> float | str | list[float]:
    """A value [SI] within the declared bounds, `share` of the way up, counted in logarithms.

    Of a list three items, evenly in the bounds, the first at `share` of the way up. Of words one of them.
    """
    if isinstance(declared, Choice):
        return str(declared.options[round(share * (len(declared.options) - 1))])
    bounds = declared.meaning.domain_si
    if isinstance(declared, Curve):
        return [bounds.ge + (bounds.le - bounds.ge) * ((share + n / 3) % 1) for n in range(3)]
    return float(bounds.ge ** (1 - share) * bounds.le**share)


def _refused(model: type[CadModel], chosen: dict[str, Any]) -> set[str]:
    """The names of the parameters that are refused before anything is drawn."""
    try:
        model.from_si(chosen).inputs_si()
    except InvalidInputs as error:
        return {fault.name for fault in error.faults}
    return set()


@st.composite
def parameters(draw: st.DrawFn, cls: type[CadModel]) -> dict[str, Value]:
    """Parameters [SI] that are near what a model draws by default, and now and then absurd."""
    chosen: dict[str, Any] = {}
    for name, declared in cls.inputs.items():
        if isinstance(declared, Choice):
            chosen[name] = draw(st.sampled_from(declared.options))
        elif declared.required:
            chosen[name] = _between(declared, draw(st.floats(0, 1)))
    if _refused(cls, chosen):
        return chosen  # choices that exclude each other, as a full bush and a free state
    defaults = cls.from_si(chosen).inputs_si()
    optional = [name for name, declared in cls.inputs.items() if isinstance(declared, Derived)]
    factors = st.sampled_from([0.0, 0.5, 0.8, 1.01, 1.25, 2.0]) | st.floats(0.3, 3) | st.floats(-1, 1000)
    for name in draw(st.lists(st.sampled_from(optional), unique=True)):
        value = float(defaults[name]) * draw(factors)
        chosen[name] = float(round(value)) if cls.inputs[name].meaning.integer else value
    return chosen


QUICK = settings(max_examples=15, suppress_health_check=list(HealthCheck))


@slow_for(*LARGE, BALLS, ("plain_bearing", 1))  # test_bearing_parts.py has random ones
@QUICK
@given(data=st.data())
def test_any_parameters_give_a_checked_solid_or_are_refused(
    model: type[CadModel], data: st.DataObject
) -> None:
    built_or_refused(model, data)


@pytest.mark.slow
@settings(QUICK, max_examples=40)
@given(data=st.data())
def test_any_more_parameters_do(model: type[CadModel], data: st.DataObject) -> None:
    built_or_refused(model, data)


def built_or_refused(model: type[CadModel], data: st.DataObject) -> None:
    chosen = data.draw(parameters(model))
    named = _refused(model, chosen)
    assert named <= set(model.inputs)
    assert named or regenerate(model.id, model.version, chosen).measures["volume"] > 0


def test_there_are_models() -> None:
    assert {"ball_bearing", "plain_bearing"} <= set(models().ids)
