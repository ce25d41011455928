"""The process in which FreeCAD opens one file, run by the Python for which FreeCAD is installed.

This module imports nothing of Crankwright, because that Python is a different one. The arguments are the
descriptor of a lifeline, the folder to which the process may write, the folders of FreeCAD's modules, and the
memory limit [MiB].

It reads requests from its standard input and answers on its standard output. Each message is a length
followed by a JSON object; an answer is followed by the shapes whose sizes it lists.

    {"do": "describe"}                    every parameter of the file, its ends and its solids
    {"do": "draw", "set": [...]}          the solids for some values, if the ends are those `at_import`
    both with "file", "seconds"           the path of the file, and the processor time it may take

Each request opens the file again, so the same values always give the same solids. Before the first request
the process gives up its access to the network, other programs and processes, signals, and files outside its
folder.
"""

import ctypes
import fcntl
import importlib
import json
import math
import os
import platform
import re
import resource
import select
import signal
import struct
import sys
import time
from collections.abc import Iterable, Iterator
from itertools import islice
from typing import Any

UNITS = {"Length": "mm", "Angle": "deg"}
LENGTHS = ("Distance", "DistanceX", "DistanceY", "Radius", "Diameter")
CELL = re.compile(r"[A-Z]{1,2}[1-9][0-9]*")
MOST_PARAMETERS = 100
MOST_SOLIDS = 100
OTHER_VALUES = "choose values nearer to those of the file, at which its parts are the same"
MOST_LEFT_OUT = 20
"""Largest number of sentences about objects that are left out."""
LARGEST_FILE = 256 * 2**20
LINKS = ("App::PropertyLink", "App::PropertyXLink")
PLACING = frozenset(
    {
        "AttachmentSupport", "Axis", "AxisLink", "Context", "Direction", "ExternalGeometry", "MirrorPlane",
        "ReferenceAxis", "Spine", "Support", "UpToFace", "UpToShape",
    }
)  # fmt: skip
"""Links that only place or orient an object; its shape does not include the linked shapes."""
BINDERS = ("PartDesign::ShapeBinder", "PartDesign::SubShapeBinder")
REPEATING = ("App::Link", "App::LinkGroup", "App::LinkElement")

DENIED = {
    # socket connect bind listen execve execveat ptrace process_vm_readv process_vm_writev kill tkill
    # io_uring_setup mount unshare setns bpf perf_event_open pidfd_open, then rt_sigqueueinfo
    # rt_tgsigqueueinfo pidfd_send_signal setpriority ioprio_set setsid setpgid truncate fchmod fchmodat
    # fchmodat2 fchown fchownat, then fork vfork chmod chown lchown if there are any
    "x86_64": (
        0xC000003E, 317,
        (41, 42, 49, 50, 59, 322, 101, 310, 311, 62, 200, 425, 165, 272, 308, 321, 298, 434,
         129, 297, 424, 141, 251, 112, 109, 76, 91, 268, 452, 93, 260, 57, 58, 90, 92, 94),
    ),
    "aarch64": (
        0xC00000B7, 277,
        (198, 203, 200, 201, 221, 281, 117, 270, 271, 129, 130, 425, 40, 97, 268, 280, 241, 434,
         138, 240, 424, 140, 30, 157, 154, 45, 52, 53, 452, 55, 54),
    ),
}  # fmt: skip
"""For each machine: its number in audit records, the number of the call `seccomp`, and the refused calls."""

OWN = {"x86_64": (234, 302, 56), "aarch64": (131, 261, 220)}
"""tgkill, prlimit64 and clone: the process may signal and limit only itself, and may start only threads."""
CLONE3, CLONE_THREAD = 435, 0x10000


def hang_on(reader: int) -> None:
    """Ask the kernel to kill this process when the server's end of a pipe closes."""
    own = os.open(f"/proc/self/fd/{reader}", os.O_RDONLY | os.O_NONBLOCK)
    fcntl.fcntl(own, fcntl.F_SETOWN, os.getpid())
    fcntl.fcntl(own, fcntl.F_SETSIG, signal.SIGKILL)
    fcntl.fcntl(own, fcntl.F_SETFL, os.O_NONBLOCK | os.O_ASYNC)
    poll = select.poll()
    poll.register(reader, 0)
    if any(event & select.POLLHUP for _, event in poll.poll(0)):
        os._exit(1)


class Filter(ctypes.Structure):
    """One instruction of the Linux kernel's packet filter, which filters system calls."""

    _fields_ = [
        ("code", ctypes.c_uint16),
        ("yes", ctypes.c_uint8),
        ("no", ctypes.c_uint8),
        ("k", ctypes.c_uint32),
    ]


class Filters(ctypes.Structure):
    """A program of such instructions."""

    _fields_ = [("length", ctypes.c_uint16), ("filters", ctypes.POINTER(Filter))]


def deny_calls(libc: ctypes.CDLL) -> None:
    """Have the Linux kernel refuse the calls in `DENIED`, in all threads and permanently.

    Raises OSError if the kernel cannot do this; the caller then opens no file.
    """
    audited, seccomp, denied = DENIED[platform.machine()]
    signal_one, limit_one, clone = OWN[platform.machine()]
    load, equal, at_least, has, answer, first = 0x20, 0x15, 0x35, 0x45, 0x06, 16
    refused, missing, killed, allowed = 0x00050000 | 1, 0x00050000 | 38, 0x80000000, 0x7FFF0000
    lines = [(load, 0, 0, 4), (equal, 1, 0, audited), (answer, 0, 0, killed), (load, 0, 0, 0)]
    lines += [(at_least, 0, 1, 0x40000000), (answer, 0, 0, refused)]  # system call numbers of x32
    for number in denied:
        lines += [(equal, 0, 1, number), (answer, 0, 0, refused)]
    # The filter cannot read the flags of clone3. If it is missing, programs use clone.
    lines += [(equal, 0, 1, CLONE3), (answer, 0, 0, missing)]
    firsts = ((signal_one, equal, os.getpid()), (limit_one, equal, 0), (clone, has, CLONE_THREAD))
    for number, test, wanted in firsts:  # compares the lower half of the first argument
        lines += [(equal, 0, 4, number), (load, 0, 0, first), (test, 0, 1, wanted)]
        lines += [(answer, 0, 0, allowed), (answer, 0, 0, refused)]
    lines.append((answer, 0, 0, allowed))
    program = (Filter * len(lines))(*(Filter(*line) for line in lines))
    all_threads = 1
    if libc.syscall(seccomp, 1, all_threads, ctypes.byref(Filters(len(lines), program))) != 0:
        raise OSError(ctypes.get_errno(), "the Linux kernel does not filter system calls")


class FileAccess(ctypes.Structure):
    """The kinds of file access that the rules control."""

    _fields_ = [("access", ctypes.c_uint64)]


class Beneath(ctypes.Structure):
    """A rule: the access allowed beneath a folder."""

    _pack_ = 1
    _fields_ = [("access", ctypes.c_uint64), ("folder", ctypes.c_int32)]


READABLE = (
    "/usr", "/lib", "/lib64", "/opt", "/sys", "/proc/self", "/etc/fonts", "/etc/ld.so.cache",
    "/etc/localtime", "/etc/passwd", "/dev/null", "/dev/zero", "/dev/random", "/dev/urandom",
)  # fmt: skip
"""Readable folders: programs, and the system files that they need; no settings or processes of others."""


def keep_to_files(libc: ctypes.CDLL, writable: str) -> None:
    """Let this process only read the system's files and write to one folder, if the kernel supports it.

    Raises OSError if the kernel supports the restriction but refuses it.
    """
    create, add, restrict, reading, of_a_file = 444, 445, 446, 0b1101, 0b101
    rules = libc.syscall(create, None, 0, 1)
    if rules < 1:
        return  # the kernel has no Landlock; the other restrictions still apply
    everything = (1 << {1: 13, 2: 14}.get(rules, 15)) - 1  # later kernels also restrict links and truncation
    ruled = libc.syscall(create, ctypes.byref(FileAccess(everything)), ctypes.sizeof(FileAccess), 0)
    places = {place: reading if os.path.isdir(place) else of_a_file for place in READABLE}
    for place, access in {**places, writable: everything}.items():
        try:
            folder = os.open(place, os.O_PATH)
        except OSError:
            continue
        libc.syscall(add, ruled, 1, ctypes.byref(Beneath(access, folder)), 0)
        os.close(folder)
    if libc.syscall(restrict, ruled, 0) != 0:
        raise OSError(ctypes.get_errno(), "the Linux kernel does not restrict access to files")
    os.close(ruled)


def mapped() -> int:
    """Return the size of this process's address space [bytes]."""
    with open("/proc/self/statm") as statm:
        return int(statm.read().split()[0]) * resource.getpagesize()


def limit(kind: int, value: int) -> None:
    """Set the soft and the hard limit of a resource."""
    hard = resource.getrlimit(kind)[1]
    value = value if hard == resource.RLIM_INFINITY else min(value, hard)
    resource.setrlimit(kind, (value, value))


def limit_time(seconds: float) -> None:
    """Have the kernel end this process after additional processor time [s], over all threads."""
    used = resource.getrusage(resource.RUSAGE_SELF)
    soft = math.ceil(used.ru_utime + used.ru_stime + seconds * (os.cpu_count() or 1)) + 1
    resource.setrlimit(resource.RLIMIT_CPU, (soft, resource.getrlimit(resource.RLIMIT_CPU)[1]))


class Refused(Exception):
    """A file or values that cannot be drawn.

    `code` and the names of the parameters' sources give the reason.
    """

    def __init__(self, code: str, detail: str, names: Iterable[str] = ()) -> None:
        super().__init__(detail)
        self.code, self.names = code, list(names)


def quantity_of(app: Any, text: str) -> Any:
    """Return the content of a cell if it is a constant; None if it is a formula or text."""
    try:
        return app.Units.Quantity(text.lstrip("=").strip()) if text.strip("= ") else None
    except Exception:
        return None


def unit_of(quantity: Any) -> str | None:
    """Return the unit of a quantity; None for kinds that are not supported."""
    if not any(quantity.Unit.Signature):
        return "1"
    return UNITS.get(quantity.Unit.Type)


def cells(app: Any, sheet: Any) -> Iterator[tuple[str, float, str]]:
    """Yield every alias of a spreadsheet whose cell contains a constant."""
    for cell in sheet.PropertiesList:
        alias = sheet.getAlias(cell) if CELL.fullmatch(cell) else None
        if not alias:
            continue
        quantity = quantity_of(app, sheet.getContents(cell))
        unit = None if quantity is None else unit_of(quantity)
        if unit is not None:
            yield alias, quantity.Value, unit


def constraints(sketch: Any) -> Iterator[tuple[str, float, str]]:
    """Yield every named driving constraint of a sketch that no expression sets."""
    bound = {entry[0].lstrip(".") for entry in sketch.ExpressionEngine}
    for number, constraint in enumerate(sketch.Constraints):
        name = constraint.Name
        if not name or not constraint.Driving or {"Constraints." + name, f"Constraints[{number}]"} & bound:
            continue
        if constraint.Type in LENGTHS or constraint.Type == "Angle":
            unit = "deg" if constraint.Type == "Angle" else "mm"
            yield name, sketch.getDatum(number).Value, unit


def parameters(app: Any, document: Any) -> list[list[Any]]:
    """Return every parameter that a document offers: [object, kind, key, value, unit, label]."""
    listed: list[list[Any]] = []
    for thing in document.Objects:
        if thing.TypeId == "Spreadsheet::Sheet":
            listed += [[thing.Name, "cell", *one, thing.Label] for one in cells(app, thing)]
        elif thing.TypeId == "Sketcher::SketchObject":
            listed += [[thing.Name, "constraint", *one, thing.Label] for one in constraints(thing)]
    if len(listed) > MOST_PARAMETERS:
        raise Refused(
            "too_large", f"it has {len(listed)} parameters; a model may have at most {MOST_PARAMETERS}"
        )
    return listed


def give(app: Any, document: Any, given: Iterable[list[Any]]) -> None:
    """Set parameters, each given as [object, kind, key, value, unit].

    Constraints of a sketch are set one by one, and in some orders an intermediate state has no solution.
    Constraints that fail are set again after the others.
    """
    waiting, failed = list(given), ""
    while waiting:
        left = []
        for one in waiting:
            try:
                give_one(app, document, *one)
            except Exception as error:
                failed = str(error)
                left.append(one)
        if len(left) == len(waiting):
            names = [f"{one[0]}.{one[2]}" for one in left]
            raise Refused("not_solved", f"FreeCAD does not accept {', '.join(names)}: {failed}", names)
        waiting = left


def give_one(app: Any, document: Any, name: str, kind: str, key: str, value: float, unit: str) -> None:
    """Set one parameter."""
    thing = document.getObject(name)
    text = repr(value) if unit == "1" else f"{value!r} {unit}"
    if kind == "cell":
        thing.set(thing.getCellFromAlias(key), text)
    else:
        thing.setDatum(key, app.Units.Quantity(text))


def recompute(document: Any) -> None:
    """Recompute the whole document; raise an error if an object fails."""
    document.recompute(None, True, True)
    faulty = [thing for thing in document.Objects if "Invalid" in thing.State or not thing.isValid()]
    if faulty:
        said = "; ".join(f"{one.Label}: {one.getStatusString()}" for one in faulty[:3])
        raise Refused("recompute", f"FreeCAD cannot draw {said}")


def is_drawn(thing: Any) -> bool:
    """Return whether an object has solids of its own, and is neither a reference nor a group."""
    return count_solids(thing) > 0


def count_solids(thing: Any) -> int:
    """Return the number of solids of an object; 0 for references and groups."""
    try:
        refers = thing.TypeId.startswith("App::") or thing.TypeId in BINDERS
        return 0 if refers else len(thing.Shape.Solids)
    except Exception:
        return 0


def is_visible(thing: Any) -> bool:
    """Return whether the file shows an object."""
    return bool(getattr(thing, "Visibility", True))


def is_empty(thing: Any) -> bool:
    """Return whether a feature of Part or PartDesign has an empty shape."""
    try:
        if not thing.isDerivedFrom("Part::Feature") or thing.isDerivedFrom("Part::Part2DObject"):
            return False
        return bool(thing.Shape.isNull() or not thing.Shape.Vertexes)
    except Exception:
        return False


def sources(thing: Any) -> set[str]:
    """Return the names of the objects from whose shapes an object creates its own.

    Objects that affect it only by expressions or attachments do not count, because these only move it or set
    its sizes.
    """
    names = set[str]()
    for name in thing.PropertiesList:
        kind = thing.getTypeIdOfProperty(name)
        if kind.startswith(LINKS) and "Hidden" not in kind and name not in PLACING:
            names.update(linked(getattr(thing, name)))
    return names - {thing.Name}


def linked(value: Any) -> Iterator[str]:
    """Yield the names of the objects in the value of a link property."""
    if isinstance(value, (list, tuple)):
        for one in value:
            yield from linked(one)
    elif hasattr(value, "TypeId"):
        yield value.Name


class Census:
    """The objects of a drawn document that have solids, and those among them that are its ends.

    An end is an object from which no other one is made; hidden ones count only if all are hidden.
    """

    def __init__(self, document: Any) -> None:
        drawn = [thing for thing in document.Objects if is_drawn(thing)]
        empty = [thing for thing in document.Objects if is_empty(thing)]
        made_of = {thing.Name: sources(thing) for thing in (*drawn, *empty)}
        used = set[str]().union(*(made_of[thing.Name] for thing in drawn))
        ends = [thing for thing in drawn if thing.Name not in used]
        shown = [thing for thing in ends if is_visible(thing)]
        self.ends = shown or ends
        self.hidden = [thing for thing in ends if thing not in self.ends]
        self.inner = [thing for thing in drawn if thing.Name in used]
        names = {thing.Name for thing in self.ends}
        self.failed = [
            thing for thing in empty if made_of[thing.Name] & names and (is_visible(thing) or not shown)
        ]

    def require_solids(self) -> None:
        """Refuse a document that has no end object, or one whose last feature has an empty shape."""
        for thing in self.failed:
            left = ", ".join(one.Label for one in self.ends if one.Name in sources(thing))
            what = f"{thing.Label} comes out empty, and is made of {left}"
            raise Refused("no_solid", f"{what}: correct {thing.Label}, or delete it and save the file")
        if not self.ends:
            remedy = "make a Body or a Part with a solid visible, and save it"
            raise Refused("no_solid", f"the file contains no visible solid: {remedy}")

    def at_import(self) -> dict[str, Any]:
        """Return the state for later comparisons: the ends with their numbers of solids, other solids."""
        return {
            "parts": [[thing.Name, count_solids(thing)] for thing in self.ends],
            "inner": [thing.Name for thing in self.inner],
        }


def require_same_ends(document: Any, there: Census, at_import: dict[str, Any]) -> None:
    """Refuse a drawing whose ends, or the numbers of their solids, differ from those at the import."""
    wanted = dict(at_import["parts"])
    for name in (*wanted, *at_import["inner"]):
        thing = document.getObject(name)
        if not is_drawn(thing):
            said = f"{thing.Label if thing else name} has no solid at these values"
            raise Refused("no_solid", f"{said}, but had one at the import: {OTHER_VALUES}")
    there.require_solids()
    found = {thing.Name: count_solids(thing) for thing in there.ends}
    for name, count in found.items():
        label = document.getObject(name).Label
        if name not in wanted:
            said = f"{label} is a part at these values, but was not one at the import"
            raise Refused("other_ends", f"{said}: {OTHER_VALUES}")
        if count != wanted[name]:
            said = f"{label} has {count} solids at these values, but had {wanted[name]} at the import"
            raise Refused("other_ends", f"{said}: {OTHER_VALUES}")
    for name in wanted:
        if name not in found:
            said = f"{document.getObject(name).Label} is not a part at these values"
            raise Refused("other_ends", f"{said}, but was one at the import: {OTHER_VALUES}")


def left_out(document: Any, there: Census) -> Iterator[str]:
    """Yield a sentence about each visible or solid object of a document that does not become a part."""
    for thing in there.hidden:
        yield f"{thing.Label} is hidden and left out"
    for thing in there.ends:
        if loose := len(thing.Shape.Faces) - sum(len(solid.Faces) for solid in thing.Shape.Solids):
            yield f"{thing.Label} has faces that belong to no solid; they are left out ({loose})"
    used = set[str]().union(*map(sources, document.Objects))
    for thing in document.Objects:
        if not is_visible(thing) or thing.Name in used:
            continue
        if thing.TypeId in REPEATING:
            yield f"{thing.Label} is a link to another object; it is left out: copy the object instead"
        elif not is_drawn(thing) and faces_of(thing):
            yield f"{thing.Label} has faces, but no solid; it is left out"


def faces_of(thing: Any) -> int:
    """Return the number of faces of an object that is neither a sketch, a datum nor a reference."""
    try:
        if thing.TypeId.startswith("App::") or thing.TypeId in BINDERS:
            return 0
        if thing.isDerivedFrom("Part::Part2DObject") or thing.isDerivedFrom("Part::Datum"):
            return 0
        return len(thing.Shape.Faces)
    except Exception:
        return 0


def solids(there: Census) -> list[tuple[str, float, bytes]]:
    """Return every solid of the ends at its position: name, volume [mm³], and shape as text."""
    listed = []
    for thing in there.ends:
        shape = thing.Shape.copy()
        shape.Placement = thing.getGlobalPlacement()
        for number, solid in enumerate(shape.Solids):
            name = thing.Label if len(shape.Solids) == 1 else f"{thing.Label} {number + 1}"
            listed.append((name, solid.Volume, solid.exportBrepToString().encode()))
    if len(listed) > MOST_SOLIDS:
        raise Refused("too_large", f"it has {len(listed)} solids; a model may have at most {MOST_SOLIDS}")
    return listed


def opened(app: Any, file: str) -> Any:
    """Open the document of a file, and close all others."""
    for name in list(app.listDocuments()):
        app.closeDocument(name)
    return app.openDocument(file, True)


def as_saved(app: Any, file: str) -> dict[str, Any]:
    """Return the ends of a file with its saved values, for models imported before ends were recorded."""
    document = opened(app, file)
    recompute(document)
    there = Census(document)
    there.require_solids()
    return there.at_import()


def answer(app: Any, request: dict[str, Any]) -> tuple[dict[str, Any], list[bytes]]:
    """Return the answer to one request, and the shapes to send after it."""
    begun, file = time.monotonic(), request["file"]
    describes = request["do"] == "describe"
    at_import = None if describes else request.get("at_import") or _first_use(app, file)
    document = opened(app, file)
    listed = parameters(app, document) if describes else []
    give(app, document, request.get("set", ()))
    recompute(document)
    there = Census(document)
    if at_import is None:
        there.require_solids()
    else:
        require_same_ends(document, there, at_import)
    shapes = solids(there)
    about = {
        "parameters": listed,
        "parts": [[name, volume] for name, volume, _ in shapes],
        "at_import": there.at_import(),
        "left_out": list(islice(left_out(document, there), MOST_LEFT_OUT)) if describes else [],
        "program": "FreeCAD " + ".".join(app.Version()[:2]),
        "seconds": time.monotonic() - begun,
    }
    return about, [shape for _, _, shape in shapes]


def _first_use(app: Any, file: str) -> dict[str, Any]:
    """Return the result of `as_saved` for the file of this process, computed only once."""
    if file not in _saved:
        _saved[file] = as_saved(app, file)
    return _saved[file]


_saved: dict[str, dict[str, Any]] = {}


def refusal(error: BaseException) -> dict[str, Any]:
    """Return an error as an answer to the request."""
    if isinstance(error, Refused):
        return {"refused": error.code, "detail": str(error), "names": error.names}
    if isinstance(error, MemoryError) or "bad_alloc" in repr(error):
        return {"refused": "memory", "detail": "", "names": []}
    return {"refused": "program", "detail": f"{type(error).__name__}: {str(error)[:500]}", "names": []}


def send(out: int, about: dict[str, Any], shapes: Iterable[bytes]) -> None:
    """Write an answer and its shapes."""
    text = json.dumps({**about, "sizes": [len(shape) for shape in shapes]}).encode()
    for piece in (struct.pack("!I", len(text)) + text, *shapes):
        left = memoryview(piece)
        while left:
            left = left[os.write(out, left) :]


def main(lifeline: int, folder: str, modules: str, memory: int) -> None:
    """Serve requests until the standard input ends."""
    requests, out = os.fdopen(os.dup(0), "rb"), os.dup(1)
    null = os.open(os.devnull, os.O_RDWR)
    for standard in (0, 1, 2):
        os.dup2(null, standard)  # FreeCAD prints messages
    hang_on(lifeline)
    libc = ctypes.CDLL(None, use_errno=True)
    if libc.prctl(38, 1, 0, 0, 0) != 0:  # no new privileges
        raise OSError("the Linux kernel refuses `no_new_privs`")
    keep_to_files(libc, folder)
    sys.path[:0] = [place for place in modules.split(os.pathsep) if place]
    import FreeCAD  # must be imported first: the other modules crash without it

    for name in ("Part", "Sketcher", "Spreadsheet", "_PartDesign"):
        importlib.import_module(name)  # imports what a file needs before most access is denied
    sys.modules["PartDesign"] = sys.modules["_PartDesign"]  # its package lies in a folder of workbenches
    deny_calls(libc)
    limit(resource.RLIMIT_CORE, 0)
    limit(resource.RLIMIT_FSIZE, LARGEST_FILE)
    limit(resource.RLIMIT_AS, mapped() + memory * 2**20)
    send(out, {"program": "FreeCAD " + ".".join(FreeCAD.Version()[:2])}, [])
    while True:
        head = requests.read(4)
        if len(head) < 4:
            os._exit(0)
        request = json.loads(requests.read(struct.unpack("!I", head)[0]))
        limit_time(request["seconds"])
        try:
            about, shapes = answer(FreeCAD, request)
        except BaseException as error:
            about, shapes = refusal(error), []
        send(out, about, shapes)


if __name__ == "__main__":
    main(int(sys.argv[1]), sys.argv[2], sys.argv[3], int(sys.argv[4]))
