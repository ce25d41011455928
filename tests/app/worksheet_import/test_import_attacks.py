"""Hostile packages and documents are refused by name, with little time and memory."""

import io
import random
import struct
import tracemalloc
import zipfile
from contextlib import suppress

import pytest
from mathcad_files import (
    SHEET,
    apply,
    call,
    define,
    define_function,
    legacy,
    legacy_math,
    math,
    name,
    packed,
    parts_of,
    prime,
    real,
    shown,
    tag,
    text,
    vector,
    words,
)

from app.worksheets.imports.errors import SheetNotRead
from app.worksheets.imports.job import imported
from app.worksheets.imports.package import MOST_BYTES, MOST_PARTS
from app.worksheets.imports.regions import MOST_REGIONS
from app.worksheets.imports.trees import DEEPEST

SMALL = parts_of(math(define("x", real(1))))
SHEET_XML = "mathcad/worksheet.xml"


def refused(content):
    """The code and the sentence with which a file is refused."""
    with pytest.raises(SheetNotRead) as caught:
        imported(content, "Sheet")
    assert len(str(caught.value)) < 400
    return caught.value.code, str(caught.value)


def flagged(content, flag):
    """A ZIP with a flag of all its entries set."""
    changed = bytearray(content)
    for mark, offset in ((b"PK\x03\x04", 6), (b"PK\x01\x02", 8)):
        place = content.find(mark)
        while place >= 0:
            changed[place + offset] |= flag
            place = content.find(mark, place + 4)
    return bytes(changed)


def document(inner, head=""):
    return f'{head}<worksheet xmlns="{SHEET}"><regions>{inner}</regions></worksheet>'


BOMB = '<!DOCTYPE b [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;">]>'
EXTERNAL = '<!DOCTYPE b [<!ENTITY x SYSTEM "file:///etc/passwd">]>'


def test_a_bomb_is_stopped_while_it_is_unpacked():
    bomb = packed({**SMALL, SHEET_XML: b"<a>" + b" " * (3 * MOST_BYTES)})
    assert len(bomb) < 200_000
    tracemalloc.start()
    code, said = refused(bomb)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert code == "too_large"
    assert "32 MiB" in said
    assert peak < 3 * MOST_BYTES


def test_bombs_in_many_text_regions_share_one_budget():
    parts = parts_of(*[words("a")] * 10)
    bomb = packed({"Xaml/Document.xaml": b"<a>" + b" " * (MOST_BYTES // 5) + b"</a>"})
    filled = {key: bomb if key.endswith("XamlPackage") else part for key, part in parts.items()}
    assert refused(packed(filled))[0] == "too_large"


def test_a_package_within_a_package_within_a_package_is_not_opened():
    inner = packed({"Xaml/Document.xaml": packed({"Xaml/Document.xaml": b"<a/>"})})
    parts = parts_of(words("a"))
    filled = {key: inner if key.endswith("XamlPackage") else part for key, part in parts.items()}
    assert refused(packed(filled))[0] == "xml"


def test_a_stated_size_that_is_a_lie_decides_nothing():
    content = bytearray(prime(math(define("x", real(1)))))
    place = content.find(b"PK\x01\x02")
    struct.pack_into("<I", content, place + 24, 1)
    assert refused(bytes(content))[0] in ("package", "xml")


@pytest.mark.parametrize("count", [MOST_PARTS + 1, 60_000])
def test_too_many_parts_are_refused_by_their_number(count):
    many = packed({**{f"part{number}": b"" for number in range(count)}, **SMALL}, zipfile.ZIP_STORED)
    code, said = refused(many)
    assert code == "too_large"
    assert "parts" in said


@pytest.mark.parametrize(
    ("path", "message"),
    [("../x", "lies outside"), ("/etc/x", "lies outside"), ("a/../../x", "lies outside"),
     ("..\\x", "lies outside"),
     ("c:\\x", "lies outside"), ("x" * 300, "lies outside")],
)  # fmt: skip
def test_a_part_whose_name_leads_out_is_refused(path, message):
    code, said = refused(packed({**SMALL, path: b""}))
    assert code == "package"
    assert message in said


def test_two_parts_of_one_name_are_refused():
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w") as archive:
        archive.writestr(SHEET_XML, SMALL[SHEET_XML])
        with pytest.warns(UserWarning, match="Duplicate"):
            archive.writestr(SHEET_XML, SMALL[SHEET_XML])
    assert "two parts" in refused(content.getvalue())[1]


def test_an_encrypted_sheet_is_refused_by_name():
    assert refused(flagged(prime(math(define("x", real(1)))), 0x1))[0] == "encrypted"


def test_another_packing_is_refused():
    assert refused(packed(SMALL, zipfile.ZIP_BZIP2))[0] == "package"


def test_a_wrong_checksum_is_refused():
    content = packed(SMALL, zipfile.ZIP_STORED)
    assert "damaged" in refused(content.replace(b"region-id", b"region_id", 1))[1]


def test_a_package_that_was_cut_anywhere_is_refused():
    content = prime(math(define("x", real(1))))
    for end in (0, 1, 3, 4, 30, len(content) // 2, len(content) - 22, len(content) - 1):
        assert refused(content[:end])[0] in ("package", "xml", "no_sheet")


def test_packages_with_changed_bytes_give_a_sheet_or_a_refusal():
    chance, content = (
        random.Random(15),
        prime(math(define("x", real(1))), words("a"), math(shown(name("x")), "1")),
    )
    for _ in range(300):
        changed = bytearray(content)
        for _ in range(chance.randint(1, 4)):
            changed[chance.randrange(len(changed))] = chance.randrange(256)
        with suppress(SheetNotRead):
            assert imported(bytes(changed), "Sheet").record["regions"] is not None


@pytest.mark.parametrize("head", [BOMB, EXTERNAL, "<!DOCTYPE a>", '<!DOCTYPE a SYSTEM "http://localhost/x">'])
@pytest.mark.parametrize("kind", ["prime", "legacy"])
def test_document_types_and_entities_are_refused(head, kind):
    inside = document("", head)
    content = packed({**SMALL, SHEET_XML: inside}) if kind == "prime" else inside.encode()
    assert refused(content)[0] == "entities"


def test_a_document_that_nests_too_deep_is_refused():
    inner = "<a>" * DEEPEST + "</a>" * DEEPEST
    assert refused(packed({**SMALL, SHEET_XML: document(inner)}))[0] == "too_deep"
    assert refused(b"<a>" * 3_000_000)[0] == "too_deep"


def test_too_many_regions_and_elements_are_refused():
    region = '<region region-id="1" top="0" left="0"><text/></region>'
    assert refused(packed({**SMALL, SHEET_XML: document(region * (MOST_REGIONS + 1))}))[0] == "too_large"
    assert refused(document("<a/>" * 200_000).encode())[0] == "too_large"


@pytest.mark.parametrize(
    "content",
    [b"", b"\0", b"PK", b"PK\x03\x04", b"PK\x05\x06" + b"\0" * 18, b"\xff\xfe\x00", b"<a", b"<a/>", b"{}",
     b'<?xml version="1.0" encoding="none-such"?><a/>', b"<a>\xff</a>",
     "<a>\ud800</a>".encode("utf-8", "surrogatepass"),
     b'<?xml version="1.0" encoding="utf-7"?><a>+ADw-</a>', b"%PDF-1.7", b"<html></html>"],
)  # fmt: skip
def test_what_is_no_sheet_is_refused(content):
    assert refused(content)[0] in ("package", "xml", "no_sheet")


def test_a_sheet_in_utf_16_is_read():
    content = legacy(legacy_math("<ml:define><ml:id>x</ml:id><ml:real>1</ml:real></ml:define>")).decode()
    assert "given x [1] = 1" in imported(content.encode("utf-16"), "Sheet").text


@pytest.mark.parametrize(
    "value",
    [
        real("1e400"), real("nan"), real("1" * 100_000), real("--1"), real(""),
        apply("factorial", real(10**9)),
        tag("range", real(0), real(10**12)),
        vector(*[real(1)] * 5_000),
        apply("summation", tag("lambda", tag("boundVars", name("k")), name("k")),
              tag("lowerBound", real(0)), tag("upperBound", real(10**12))),
        text("__import__('os').system('true')"),
        call("__import__", text("os")),
        tag("apply"), tag("define"), tag("eval"), tag("program"), tag("matrix"),
        tag("ComboBoxControl", rows="x"),
    ],
)  # fmt: skip
def test_a_region_that_asks_too_much_is_refused_alone(value):
    records = imported(prime(math(define("y", value)), math(define("z", real(1)))), "Sheet").record["regions"]
    assert records[0]["state"] == "refused"
    assert records[1]["state"] == "unverified"


@pytest.mark.parametrize("base", [9, 10, "1e200"])
def test_a_power_without_end_has_no_value(base):
    tower = apply("pow", real(base), apply("pow", real(10), real(300)))
    assert imported(prime(math(define("y", tower))), "Sheet").record["regions"][0]["state"] == "differs"


def test_functions_that_double_or_call_themselves_end():
    doubling = [math(define_function("f0", ["a"], apply("plus", name("a"), name("a"))))]
    for number in range(1, 30):
        one = call(f"f{number - 1}", name("a"))
        doubling.append(math(define_function(f"f{number}", ["a"], apply("plus", one, one))))
    doubling.append(math(define("y", call("f29", real(1)))))
    assert imported(prime(*doubling), "Sheet").record["regions"][-1]["state"] in ("refused", "blocked")
    itself = define_function("g", ["a"], call("g", apply("plus", name("a"), real(1))))
    called = imported(prime(math(itself), math(define("y", call("g", real(1))))), "Sheet")
    assert called.record["regions"][-1]["state"] in ("refused", "blocked")


@pytest.mark.parametrize(
    "said", ['x" (> 0)\ngiven y [m] "y', "a\u2028b", "\u202eabc", "x\\y{}", "`x`", "given", "level", ""]
)
def test_no_name_or_text_writes_a_line_of_its_own(said):
    safe = said.replace("&", "").replace("<", "")
    sheet = imported(prime(math(define(name(safe), real(1))), words(safe or "a")), "Sheet")
    lines = sheet.text.split("\n")
    assert len(lines) <= 6
    assert not any(line.startswith("given y") for line in lines)
