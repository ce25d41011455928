"""Worksheets for tests, and the steps to their release over HTTP."""

import itertools

from serving import API

BUSH = """# Bush duty
> Steady load, **aligned** journal.

given F [kN] "radial load" (>= 0; example 25 kN)
given D [mm] "bearing diameter" (> 0; <= 2 m; example 48 mm)
given B [mm] = D / 2 "bearing width" (> 0)

p [MPa] = F / (D * B) "projected pressure"
bore [mm] = D + 0.05 mm "finished bore"

require B <= 2 * D "The bush is at most twice as long as wide" (remedy "use two")
check p <= 30 MPa "white metal carries it"
test "by hand" with F = 25 kN gives p = 21.7 MPa within 0.2 %
"""
WIDER = BUSH.replace("0.05 mm", "0.06 mm")
"""The same with other results."""
FAULTY = BUSH.replace('F / (D * B) "', 'F / D "')
"""The pressure is no pressure."""

_numbers = itertools.count(1)


def fresh(word="bush"):
    """An id that no other test has."""
    return f"{word}_{next(_numbers)}"


def place(id, *parts):
    return "/".join((f"{API}/worksheets/{id}", *map(str, parts)))


def drafted(http, text=BUSH, id="", **more):
    """A new draft."""
    answer = http.post(f"{API}/worksheets", json={"id": id or fresh(), "text": text, **more})
    assert answer.status_code == 201, answer.text
    return answer.json()


def step(http, id, name, **body):
    """One step of the life of a worksheet, which must succeed."""
    answer = http.post(place(id, name), **({"json": body} if body else {}))
    assert answer.status_code == 200, answer.text
    return answer.json()


def reviewed(http, id, reviewer="B. Klein"):
    digest = step(http, id, "test")["digest"]
    return step(http, id, "review", reviewer=reviewer, digest=digest)


def released(http, text=BUSH, id="", author="A. Weber"):
    """A released worksheet; of one that is there the next version."""
    sheet = drafted(http, text, id, author=author)
    reviewed(http, sheet["id"])
    return step(http, sheet["id"], "release")


def edited(http, sheet, text):
    """A worksheet after an edit."""
    headers = {"If-Match": f'"{sheet["edit"]}"'}
    answer = http.patch(place(sheet["id"]), json={"text": text}, headers=headers)
    assert answer.status_code == 200, answer.text
    return answer.json()
