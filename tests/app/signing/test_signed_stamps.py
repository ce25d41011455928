"""Signed stamps: accepted if every byte is as it was signed, and in no other case."""

import json
import random
import re
import time
import tracemalloc
from collections import Counter

import pytest
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey
from patience import patient

from app.designs.stamps import sent
from app.signing.keys import PublicKey, StampKeys, public_keys_in
from app.signing.verification import EXIT_CODES, verify
from cad.catalogue import models
from cad.export import derive
from cad.header import read_header
from cad.regenerate import regenerate
from cad.signed_file import digest_of, message, read_part, signed, without_claims
from cad.stamp import Stamp, is_copy, stamped
from cad.step import read_step

ORDER = 2**252 + 27742317777372353535851937790883648493  # of the group of Ed25519
STAMP = Stamp(
    "A bush */ 'FILE_NAME(' ﬁt", "bush", 3, "2026-12-01T03:04:05", mass=1.25, id="d-1", build="ab" * 32
)
OTHER = Stamp("Another bush", "bush", 4, "2026-12-01T04:05:06", mass=1.25, id="d-2", build="cd" * 32)


@pytest.fixture(scope="module")
def build():
    return bush("24 mm")


def bush(width):
    cls = models().get("flanged_bush", 1)
    shape = cls.from_quantities({**cls.example, "width": width})
    return regenerate(cls.id, cls.version, shape.inputs_si())


@pytest.fixture(scope="module")
def stored(build):
    return {"step": build.step, "glb": derive(build.step, "glb")}


@pytest.fixture(scope="module")
def keys(tmp_path_factory):
    keys = StampKeys(tmp_path_factory.mktemp("keys") / "stamp-keys")
    keys.create()
    return keys


@pytest.fixture
def judged(tmp_path, keys):
    """The verdict on bytes, for which the service's keys may sign."""

    def judge(data, trusted=None):
        path = tmp_path / "file"
        path.write_bytes(data)
        return verify(path, keys.public() if trusted is None else trusted)

    return judge


@pytest.mark.parametrize("kind", ["step", "glb"])
def test_a_signed_file_is_valid_and_names_the_relations_of_its_faces(stored, keys, judged, kind):
    data = sent(stored[kind], kind, "0" * 64, STAMP, keys)
    verdict = judged(data)
    assert (verdict.kind, verdict.key.public) == ("valid", keys.current.public)
    claims = verdict.claims
    assert claims["design"] == {"id": "d-1", "name": STAMP.design}
    assert (claims["revision"], claims["model"], claims["kind"]) == (3, "bush", kind)
    assert claims["build"] == {"key": "ab" * 32, "sha256": "0" * 64}
    assert claims["relations"]["width"] == "bush.width"
    assert sent(stored[kind], kind, "0" * 64, STAMP, keys) == data


def test_a_signed_step_file_is_read_by_the_kernel_and_recognised_as_a_copy(stored, keys):
    data = sent(stored["step"], "step", "0" * 64, STAMP, keys)
    (body,) = read_step(data)
    assert len(body.shape.Faces()) == 14
    assert read_header(data) == read_header(stored["step"])
    assert without_claims(data) == stamped(stored["step"], "step", STAMP)
    assert is_copy(data, stored["step"])
    assert not is_copy(data.replace(b"ADVANCED_FACE", b"ADVANCED_FACF", 1), stored["step"])


def test_what_is_signed_is_what_the_documentation_says(stored, keys, tmp_path):
    """By hand: zeros in place of the signature, SHA-256, a title; the signature verifies that message."""
    import hashlib

    data = sent(stored["step"], "step", "0" * 64, STAMP, keys)
    (digits,) = re.findall(rb'"signature": "([0-9a-f]{128})"', data)
    digest = hashlib.sha256(data.replace(digits, b"0" * 128)).digest()
    signature = bytes.fromhex(digits.decode())
    assert keys.current.accepts(signature, b"Crankwright stamp 1\n" + digest)
    (tmp_path / "file").write_bytes(data)
    assert digest_of(tmp_path / "file", read_part(data)) == digest


def flipped(data, low, high, chance):
    place = chance.randrange(low, high)
    return data[:place] + bytes([data[place] ^ 1 << chance.randrange(8)]) + data[place + 1 :]


def with_claims(data, change, sign, claims=None):
    """The file with changed claims; signed anew by `sign`, or with its old signature if that is None."""
    part = read_part(data)
    claims = json.loads(json.dumps(claims or part.claims))
    change(claims)
    bare = (data.startswith(b"glTF") and bare_glb(data)) or without_claims(data)
    kind = "glb" if data.startswith(b"glTF") else "step"
    return signed(bare, kind, claims, sign or (lambda _: part.signature))


def bare_glb(data):
    """The GLB file without claims, by another way than the program's."""
    length = int.from_bytes(data[12:16], "little")
    about = json.loads(data[20 : 20 + length])
    del about["asset"]["extras"]
    text = json.dumps(about, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    rest = data[20 + length :]
    head = b"glTF" + b"".join(n.to_bytes(4, "little") for n in (2, 20 + len(text) + len(rest), len(text)))
    return head + b"JSON" + text + rest


def edited_dimension(data, chance):
    """The file with another digit in one of its numbers."""
    places = [m.start() for m in re.finditer(rb"(?<=[0-9])\.[0-9]", data)]
    place = chance.choice(places) - 1
    return data[:place] + bytes([48 + (data[place] - 48 + 1) % 10]) + data[place + 1 :]


def recomputed(data, chance):
    """A changed file, whose claims have the SHA-256 of the changed bytes."""
    import hashlib

    changed = flipped(data, len(data) // 2, len(data), chance)
    return with_claims(
        changed, lambda claims: claims["build"].update(sha256=hashlib.sha256(changed).hexdigest()), None
    )


def rewritten_claims(data, chance):
    changes = (
        lambda c: c.update(revision=c["revision"] + chance.randrange(1, 9)),
        lambda c: c["design"].update(name=f"design {chance.random()}"),
        lambda c: c["design"].update(id=f"{chance.getrandbits(64):x}"),
        lambda c: c["relations"].update(width=f"bush.{chance.getrandbits(32):x}"),
        lambda c: c.update(date=f"2027-01-01T00:00:{chance.randrange(60):02}"),
    )
    return with_claims(data, chance.choice(changes), None)


def signature_of(data):
    part = read_part(data)
    return part, data[: part.place], data[part.place + 128 :]


def larger_scalar(data, chance):
    """The signature with its scalar plus the order of the group: equal for a careless verification."""
    part, before, after = signature_of(data)
    scalar = int.from_bytes(part.signature[32:], "little") + ORDER * chance.randrange(1, 9)
    return before + (part.signature[:32] + scalar.to_bytes(32, "little")).hex().encode() + after


def capitals(data, chance):
    part, before, after = signature_of(data)
    digits = part.signature.hex()
    letters = [n for n, digit in enumerate(digits) if digit in "abcdef"]
    chosen = set(chance.sample(letters, chance.randrange(1, 8)))
    return before + "".join(d.upper() if n in chosen else d for n, d in enumerate(digits)).encode() + after


def moved(data, chance):
    """The file with two of its parts exchanged."""
    low = len(data) // 3
    a, b, c = sorted(chance.sample(range(low, len(data)), 3))
    return data[:a] + data[b:c] + data[a:b] + data[c:]


def cases(original, other, stranger, chance):
    """Files that a forger makes of an original, of another file of the service, and with a key of its own."""
    part = read_part(original)
    start, size = part.place + 140, len(original)
    _, before, after = signature_of(original)
    foreign = read_part(other)
    line = chance.randrange(start, size)
    yield "flip in the data", flipped(original, size // 2, size, chance)
    yield "flip in the header", flipped(original, 0, part.place, chance)
    yield "flip in the signature", flipped(original, part.place, part.place + 128, chance)
    yield "flip behind the stamp", flipped(original, start, start + 2000, chance)
    yield "edited number", edited_dimension(original, chance)
    yield "recomputed hash", recomputed(original, chance)
    yield "rewritten claims", rewritten_claims(original, chance)
    yield "the other's signature", before + foreign.signature.hex().encode() + after
    yield (
        "the other's stamp",
        with_claims(original, lambda c: (c.clear(), c.update(foreign.claims)), lambda _: foreign.signature),
    )
    yield (
        "another service's key",
        with_claims(rewritten_claims(original, chance), lambda c: None, stranger.sign),
    )
    named = PublicKey.of(stranger).id
    yield "another service's key, named", with_claims(original, lambda c: c.update(key=named), stranger.sign)
    yield "truncated", original[: chance.randrange(100, size)]
    yield "appended", original + bytes(chance.randrange(256) for _ in range(chance.randrange(1, 50)))
    yield "inserted", original[:line] + bytes([chance.choice(b" \n\t0")]) + original[line:]
    yield "removed", original[:line] + original[line + chance.randrange(1, 9) :]
    yield "exchanged", moved(original, chance)
    yield "random signature", before + chance.randbytes(64).hex().encode() + after
    yield "no signature", before + b"0" * 128 + after
    yield "larger scalar", larger_scalar(original, chance)
    yield "capitals", capitals(original, chance)
    yield "stamp of the other before it", with_prefix(original, other)
    yield "line ends", original.replace(b"\n", b"\r\n", chance.randrange(1, 30))


def with_prefix(original, other):
    """The file with a second stamp in front of its own."""
    if original.startswith(b"glTF"):
        return other[: read_part(other).place + 140] + original[read_part(original).place + 140 :]
    begin = len(b"ISO-10303-21;\nHEADER;\n")
    return other[: other.index(b"*/\n") + 3] + original[begin:]


@pytest.mark.parametrize("count", [200, pytest.param(1000, marks=pytest.mark.slow)])
def test_no_forged_file_is_accepted(stored, keys, judged, count):
    chance = random.Random(40)
    stranger = Ed25519PrivateKey.generate()
    other = bush("25 mm").step
    files = {"step": (stored["step"], other), "glb": (stored["glb"], derive(other, "glb"))}
    pairs = [
        [sent(file, kind, "0" * 64, stamp, keys) for file, stamp in zip(two, (STAMP, OTHER), strict=True)]
        for kind, two in files.items()
    ]
    genuine = {data for pair in pairs for data in pair}
    assert all(judged(data).kind == "valid" for data in genuine)
    verdicts, kinds = Counter(), Counter()
    while sum(verdicts.values()) < count:
        for pair in pairs:
            original, other = chance.sample(pair, 2)
            for name, forged in cases(original, other, stranger, chance):
                if forged in genuine:
                    assert name in ("line ends", "exchanged"), name  # a GLB file has few line ends
                    continue
                verdicts[judged(forged).kind] += 1
                kinds[name] += 1
    assert verdicts["valid"] == 0
    assert len(kinds) == 22
    assert min(kinds.values()) >= count // 70
    assert verdicts["tampered"] > verdicts["other_key"] > 0


def test_a_key_of_another_service_is_a_verdict_of_its_own(stored, keys, judged):
    data = sent(stored["step"], "step", "0" * 64, STAMP, keys)
    stranger = PublicKey.of(Ed25519PrivateKey.generate())
    verdict = judged(data, [stranger])
    assert verdict.kind == "other_key"
    assert keys.current.id in verdict.words
    assert stranger.id in verdict.words
    assert judged(data, []).kind == "other_key"
    assert judged(data, [stranger, keys.current]).kind == "valid"


def test_unsigned_and_exported_files_have_verdicts_of_their_own(build, stored, keys, judged):
    for kind in ("step", "glb"):
        assert judged(stored[kind]).kind == "unsigned"
        assert judged(sent(stored[kind], kind, "", STAMP, None)).kind == "unsigned"
    data = sent(stored["step"], "step", "0" * 64, STAMP, keys)
    exported = rewritten_header(data)
    verdict = judged(exported)
    assert verdict.kind == "re_exported"
    assert "written by Processor 1, ACME CAD" in verdict.words
    foreign = re.sub(rb"(?i)crankwright", b"", exported)
    assert judged(foreign).kind == "unsigned"
    assert "no" not in judged(foreign).words.split()[:1]
    assert judged(b"no file of CAD").kind == "unreadable"
    assert judged(b"").kind == "unreadable"


def rewritten_header(step):
    """The file as a program writes it that keeps products and their descriptions."""
    return (
        b"ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('part','2026-12-01T00:00:00',"
        b"('it''s me'),(''),'Processor 1','ACME CAD','');\nFILE_SCHEMA(('AP214'));\nENDSEC;\n"
        + step[step.index(b"DATA;") :]
    )


def test_exit_codes_differ():
    assert EXIT_CODES["valid"] == 0
    assert len(set(EXIT_CODES.values())) == len(EXIT_CODES)
    assert 2 not in EXIT_CODES.values()


def test_hostile_headers_take_linear_time(judged):
    seconds = []
    for count in (20_000, 40_000):
        data = b"ISO-10303-21;\nHEADER;\nFILE_NAME(" + b"'',(" * count
        begin = time.perf_counter()
        judged(data)
        judged(b"ISO-10303-21;\nHEADER;\n/* Crankwright stamp {" + b'"signature": "' * count)
        judged(b"ISO-10303-21;\nHEADER;\n/* Crankwright stamp " + b'{"a":' * count + b'"signature": "')
        seconds.append(time.perf_counter() - begin)
    assert seconds[1] < patient(2.0)


@pytest.mark.slow
def test_a_file_of_200_mb_takes_seconds_and_little_memory(keys, tmp_path):
    line = b"#1 = CARTESIAN_POINT('',(0.,0.,0.));\n"
    data = b"ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\n" + line * (200_000_000 // len(line))
    path = tmp_path / "large.step"
    path.write_bytes(signed(data, "step", {"key": keys.current.id}, keys.sign))
    del data
    trusted = keys.public()
    tracemalloc.start()
    begin = time.process_time()
    assert verify(path, trusted).kind == "valid"
    seconds = time.process_time() - begin
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert seconds < patient(10.0)
    assert peak < 8 * 2**20


def test_public_keys_are_found_in_any_text():
    one, other = (PublicKey.of(Ed25519PrivateKey.generate()) for _ in range(2))
    text = json.dumps({"items": [{"public": one.public}, {"public": other.public}, {"public": one.public}]})
    assert public_keys_in(text) == [one, other]
    assert public_keys_in("ed25519:0123") == []
    assert message(b"x") == b"Crankwright stamp 1\nx"
