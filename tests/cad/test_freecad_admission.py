"""FreeCAD files before they are opened: what is accepted, removed and refused."""

import io
import time
import zipfile

import pytest

from cad.errors import UnreadableModel
from cad.freecad import admission
from cad.freecad.admission import DOCUMENT, admitted

PLAIN = '<Object type="PartDesign::Body" name="Body" id="1"/>'


def document(inside=PLAIN):
    return f'<?xml version="1.0"?><Document SchemaVersion="4"><Objects>{inside}</Objects></Document>'.encode()


def packed(parts=None, method=zipfile.ZIP_DEFLATED):
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", method) as package:
        for name, content in {DOCUMENT: document(), **(parts or {})}.items():
            package.writestr(name, content)
    return out.getvalue()


def refusal(content):
    begun = time.monotonic()
    with pytest.raises(UnreadableModel) as caught:
        admitted(content)
    assert time.monotonic() - begun < 5
    return caught.value.code


def test_only_parts_that_the_document_names_are_left():
    inside = PLAIN + '<Part file="Shape.brp"/>'
    content = packed({DOCUMENT: document(inside), "Shape.brp": b"shape", "run.FCMacro": b"1", "a/b.py": b"1",
                      "GuiDocument.xml": b"<x/>"})  # fmt: skip
    with zipfile.ZipFile(io.BytesIO(admitted(content))) as package:
        assert package.namelist() == [DOCUMENT, "Shape.brp"]


@pytest.mark.parametrize(
    ("inside", "code"),
    [
        ('<Object type="Part::FeaturePython" name="S"/>', "python_feature"),
        ('<Object type="App::FeaturePython" name="S"/>', "python_feature"),
        ('<Object type="Sketcher::SketchObjectPython" name="S"/>', "python_feature"),
        ('<Property name="Proxy" type="App::PropertyPythonObject"/>', "python_feature"),
        ('<Property name="P"><Python value="x" module="os" class="system"/></Property>', "python_feature"),
        ('<Extension type="App::GroupExtensionPython" name="E"/>', "python_feature"),
        ('<Object type="Part::ImportStep" name="S"/>', "reads_files"),
        ('<Property name="F" type="App::PropertyFile"/>', "reads_files"),
        ('<Property name="F" type="App::PropertyFileIncluded"/>', "reads_files"),
        ('<XLink file="/etc/other.FCStd" name="Body"/>', "reads_files"),
        ('<Object type="Fem::FemSolverObject" name="S"/>', "not_offered"),
        ('<Object type="Path::Feature" name="S"/>', "not_offered"),
        (200 * "<a>" + 200 * "</a>", "package"),
    ],
)
def test_what_runs_python_or_reads_files_is_refused(inside, code):
    assert refusal(packed({DOCUMENT: document(inside)})) == code


def test_declared_entities_are_refused():
    bomb = b'<!DOCTYPE d [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;">]><Document>&b;</Document>'
    assert refusal(packed({DOCUMENT: bomb})) == "package"


def test_a_bomb_is_refused_by_what_it_unpacks_to(monkeypatch):
    assert admission.MOST_BYTES == 64 * 2**20
    monkeypatch.setattr(admission, "MOST_BYTES", 2**20)
    content = packed({"Shape.brp": bytes(2**20)})
    assert len(content) < 2**12
    assert refusal(content) == "too_large"


def test_a_crowd_of_parts_is_refused():
    assert refusal(packed({f"{n}.brp": b"" for n in range(3000)})) == "too_large"


@pytest.mark.parametrize(
    "content",
    [b"", b"PK\x03\x04", packed()[:-30], packed({DOCUMENT: b"<Document>"}), packed()[:40] + packed()[60:]],
)
def test_a_damaged_package_is_refused(content):
    assert refusal(content) == "package"


@pytest.mark.parametrize("parts", [{DOCUMENT: b"<html/>"}])
def test_another_document_is_refused(parts):
    assert refusal(packed(parts)) == "not_freecad"


def test_a_package_without_a_document_is_refused():
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w") as package:
        package.writestr("word/document.xml", "<x/>")
    assert refusal(out.getvalue()) == "not_freecad"


@pytest.mark.parametrize("method", [zipfile.ZIP_LZMA, zipfile.ZIP_BZIP2])
@pytest.mark.parametrize("place", [None, 44, 60, 100])
def test_a_package_of_another_method_is_refused_damaged_or_not(method, place):
    content = bytearray(packed(method=method))
    if place is not None:
        content[place] ^= 0x55
    assert refusal(bytes(content)) == "package"


@pytest.mark.parametrize("encoding", ["utf-16", "utf-7", "cp1252", "unicode_escape", "hex", "idna", "none"])
def test_a_document_in_another_encoding_is_refused(encoding):
    text = document().decode().replace("?>", f' encoding="{encoding}"?>', 1)
    assert refusal(packed({DOCUMENT: text})) == "package"


@pytest.mark.parametrize("encoding", ["utf-16", "utf-16-le", "utf-16-be"])
def test_a_document_in_utf_16_is_refused(encoding):
    assert refusal(packed({DOCUMENT: f"<Document>{PLAIN}</Document>".encode(encoding)})) == "package"


def test_a_document_that_says_utf_8_is_taken():
    text = document().decode().replace("?>", ' encoding="UTF-8"?>', 1)
    assert admitted(packed({DOCUMENT: text}))


def test_a_part_without_a_name_is_left_out():
    nameless = bytearray(packed({"x": b"nameless"}, zipfile.ZIP_STORED))
    first, second = nameless.index(b"xnameless"), nameless.rindex(b"x")
    nameless[second - 46 + 28] = nameless[first - 4] = 0  # the lengths of its name, in both places
    for place in (second, first):
        del nameless[place]
    end = nameless.rindex(b"PK\x05\x06")
    size, start = nameless[end + 12], nameless[end + 16]
    nameless[end + 12], nameless[end + 16] = size - 1, start - 1
    with zipfile.ZipFile(io.BytesIO(admitted(bytes(nameless)))) as package:
        assert package.namelist() == [DOCUMENT]


def test_a_directory_that_says_its_size_twice_is_refused():
    content = packed()
    end = content.rindex(b"PK\x05\x06")
    locator = b"PK\x06\x07" + bytes(16)
    assert refusal(content[:end] + locator + content[end:]) == "package"


def test_what_is_stored_of_a_bomb_is_small():
    content = packed({DOCUMENT: document('<Part file="Shape.brp"/>'), "Shape.brp": bytes(2**23)})
    assert len(admitted(content)) < 2**17
