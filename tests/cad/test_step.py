import pickle
import re

import pytest
from cadquery import func

from cad.catalogue import models
from cad.errors import GeometryError, UnreadableStep
from cad.header import Header, read_header, write_header
from cad.model import STEEL, Part
from cad.step import read_step, write_step

ODD = "it's a \\ µ, 轴承: 5 mm"


def box(name: str, volume: float = 6.0) -> Part:
    return Part(name, func.box(1, 2, 3), volume)


def test_header_survives_quotes_backslashes_and_other_alphabets() -> None:
    header = Header("ball_bearing", 12, {"inner_diameter": "50 mm", "note": ODD}, "ab" * 32)
    text = write_header(header, "SCHEMA", "kernel")
    assert text.isascii()
    assert read_header(f"ISO-10303-21;\n{text}\nDATA;".encode()) == header


def test_no_string_of_the_header_is_longer_than_the_standard_allows(example_of) -> None:
    for model in models():
        header = example_of(model).step.split(b"ENDSEC;")[0].decode()
        assert max(map(len, re.findall(r"'(?:[^']|'')*'", header))) <= 258


@pytest.mark.parametrize(
    "other",
    [
        b"",
        b"no STEP file",
        b"ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION(('Open CASCADE Model'),'2;1');\nENDSEC;",
        b"HEADER;\nFILE_DESCRIPTION((''),'2;1');ENDSEC;",
        b"HEADER;\nFILE_DESCRIPTION(('Crankwright box version 1'),'2;1');ENDSEC;",
        b"\xff\xfe" * 100,
    ],
)
def test_header_of_another_program_is_none(other: bytes) -> None:
    assert read_header(other) is None


def test_names_and_colours_come_back() -> None:
    (body,) = read_step(write_step([box("block")], Header("box", 1, {}, "")))
    assert body.name == "block"
    assert body.colour == pytest.approx(STEEL, abs=1e-6)


def test_bytes_do_not_depend_on_what_was_written_before() -> None:
    header = Header("box", 1, {}, "")
    first = write_step([box("block")], header)
    write_step([box("a"), box("b")], header)
    assert write_step([box("block")], header) == first


def test_schema_is_ap242(example_of) -> None:
    for model in models():
        step = example_of(model).step
        assert b"AP242" in step[:2000]
        assert b"'ap242_managed_model_based_3d_engineering'" in step
        assert b"1970-01-01T00:00:00" in step


def test_bytes_that_are_no_step_file_are_refused() -> None:
    with pytest.raises(UnreadableStep):
        read_step(b"no STEP file")


def test_geometry_error_survives_the_way_out_of_a_process() -> None:
    error = pickle.loads(pickle.dumps(GeometryError("volume", "too small", ["wall"])))
    assert (error.code, error.detail, error.parameters, str(error)) == (
        "volume",
        "too small",
        ("wall",),
        "too small",
    )
