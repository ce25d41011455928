"""Import the kernel on demand, so that a process that builds no shape, such as the server, never imports it.

CadQuery, OpenCASCADE and the drawing libraries take seconds to import, and more memory than the rest of the
server, which needs only the parameters of a model. After `postpone`, modules import placeholders instead. The
first use of a placeholder (a call, an attribute) imports the kernel and replaces all placeholders in all
modules by the real objects. So all code works as usual, but the import happens later.

Modules that need the kernel during their own import use `constant` and `once_loaded`.

The kernel is then loaded without VTK, with which CadQuery shows shapes on a screen; VTK gets placeholders
too. Our functions do not use VTK; a team's model may, and its first use imports it.
"""

from __future__ import annotations

import os
import sys
import threading
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from importlib import import_module
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from types import ModuleType
from typing import TypeVar, cast

T = TypeVar("T")

PACKAGES = frozenset({"cadquery", "OCP", "ezdxf", "typst", "PIL"})
"""Packages whose imports are postponed together."""
DISPLAY = frozenset({"vtkmodules", "OCP.IVtk", "OCP.IVtkOCC", "OCP.IVtkVTK"})
"""Packages that stay postponed when the kernel is loaded; they take 110 MB."""


def postpone() -> None:
    """Give placeholders to modules that are imported from now on.

    Do nothing if the kernel is already loaded.
    """
    if not is_loaded() and not is_postponed():
        sys.meta_path.insert(0, _finder)


def is_loaded() -> bool:
    """Return whether any module has imported the kernel itself."""
    return isinstance(sys.modules.get("OCP"), ModuleType) and not isinstance(sys.modules["OCP"], _Module)


def is_postponed() -> bool:
    """Return whether modules get placeholders."""
    return _finder in sys.meta_path


def constant(make: Callable[[], T]) -> T:
    """Return a value that the kernel creates, or a placeholder for it if the kernel is postponed."""
    return cast(T, StandIn(make)) if is_postponed() else make()


def once_loaded(act: Callable[[], object]) -> None:
    """Call a function that sets up the kernel: now, or when the kernel is loaded."""
    if is_postponed():
        _following.append(act)
    else:
        act()


def load() -> None:
    """Import the kernel and replace the placeholders; a second call does nothing."""
    with _loading:
        if not is_postponed():
            return
        sys.meta_path.remove(_finder)
        _forget(_Module)
        sys.meta_path.insert(0, _display)
        import_module("cadquery")
        for name in list(sys.modules):
            if _may_hold(name):
                _complete(sys.modules[name], StandIn)
        while _following:
            _following.pop(0)()


def _load_display() -> None:
    """Import VTK itself; a second call does nothing."""
    with _loading:
        if _display in sys.meta_path:
            sys.meta_path.remove(_display)
            _forget(_DisplayModule)
            for name in list(sys.modules):
                if name.partition(".")[0] == "cadquery" or _may_hold(name):
                    _complete(sys.modules[name], _DisplayStandIn)


def _forget(kind: type[ModuleType]) -> None:
    """Remove the placeholder modules of a kind, so that the real modules are imported."""
    for name in [name for name, module in sys.modules.items() if type(module) is kind]:
        del sys.modules[name]


def _may_hold(name: str) -> bool:
    """Return whether a module may contain placeholders; modules of Python itself, for example, cannot.

    Looking through a namespace changes the reference counts of all its objects. A forked process would then
    copy the memory of everything that its server has imported.
    """
    if name in sys.builtin_module_names:
        return False
    place = getattr(sys.modules[name], "__file__", None) or ""
    is_foreign = place.startswith(_PYTHON) or "site-packages" in place
    return not is_foreign or name.partition(".")[0] in _asking


def _complete(module: ModuleType, kind: type[StandIn]) -> None:
    """Replace the placeholders of a kind in the namespace of a module by the real objects."""
    names = getattr(module, "__dict__", {})
    for name, value in list(names.items()):
        if type(value) is kind:
            names[name] = value.real()


class StandIn:
    """A placeholder for an object of the kernel that is not imported yet.

    It forwards every use to the object.
    """

    def __init__(self, make: Callable[[], object]) -> None:
        self.__dict__["_make"] = make

    _load: Callable[[], None] = staticmethod(load)

    def real(self) -> object:
        """Return the real object."""
        self._load()
        if "_real" not in self.__dict__:
            make: Callable[[], object] = self.__dict__["_make"]
            self.__dict__["_real"] = make()
        return self.__dict__["_real"]

    def __getattr__(self, name: str) -> object:
        """Return an attribute of the real object."""
        return getattr(self.real(), name)

    def __call__(self, *args: object, **options: object) -> object:
        """Call the real object; placeholders among the arguments are replaced by their real objects."""
        named = {name: _real(value) for name, value in options.items()}
        return cast(Callable[..., object], self.real())(*map(_real, args), **named)

    def __getitem__(self, key: object) -> object:
        """Return an item of the real object, such as the value of a table."""
        return cast(Mapping[object, object], self.real())[key]

    def __iter__(self) -> Iterator[object]:
        """Yield the items of the real object."""
        return iter(cast(Iterable[object], self.real()))

    def __neg__(self) -> object:
        """Return the negative of the real object, such as the opposite of a direction."""
        return -cast(float, self.real())

    def __instancecheck__(self, instance: object) -> bool:
        """Return whether something is an instance of the class.

        While the kernel is not loaded, there are no instances.
        """
        return not is_postponed() and isinstance(instance, cast(type, self.real()))

    def __mro_entries__(self, bases: tuple[object, ...]) -> tuple[object, ...]:
        """Return the real class if a class inherits from the placeholder."""
        return (self.real(),)


class _DisplayStandIn(StandIn):
    """A placeholder for an object of VTK, in a module of the kernel or of a team."""

    _load = staticmethod(_load_display)

    def __getattr__(self, name: str) -> object:
        """Return an attribute of the real object.

        Refuse the attributes by which `typing` recognises annotations.
        """
        if name.startswith("__"):
            raise AttributeError(name)
        return super().__getattr__(name)

    def __instancecheck__(self, instance: object) -> bool:
        """Return whether something is an instance of the class.

        Before VTK is loaded there are no instances.
        """
        return _display not in sys.meta_path and isinstance(instance, cast(type, self.real()))


def _real(value: object) -> object:
    return value.real() if isinstance(value, StandIn) else value


class _Module(ModuleType):
    """A placeholder for a module of the kernel while others import names from it."""

    def __getattr__(self, name: str) -> object:
        if name.startswith("__"):
            raise AttributeError(name)
        _asking.add(str(sys._getframe(1).f_globals.get("__name__", "")).partition(".")[0])
        place = self.__name__
        return StandIn(lambda: _imported(place, name))


class _DisplayModule(ModuleType):
    """A placeholder for a module of VTK, or for the kernel's part that uses it."""

    def __getattr__(self, name: str) -> object:
        if name.startswith("__"):
            raise AttributeError(name)
        place = self.__name__
        return _DisplayStandIn(lambda: _imported(place, name))


def _imported(place: str, name: str) -> object:
    """Return the object that `from place import name` would import: an attribute or a module."""
    module = import_module(place)
    return getattr(module, name) if hasattr(module, name) else import_module(f"{place}.{name}")


class _Finder(MetaPathFinder, Loader):
    """Import hook that finds a placeholder for each module of some packages."""

    def __init__(self, packages: frozenset[str], kind: type[ModuleType]) -> None:
        self._packages, self._kind = packages, kind

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Return the spec of a placeholder if the module belongs to one of these packages."""
        is_ours = not self._packages.isdisjoint((fullname, fullname.partition(".")[0]))
        return ModuleSpec(fullname, self, is_package=True) if is_ours else None

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        """Return an empty module."""
        return self._kind(spec.name)

    def exec_module(self, module: ModuleType) -> None:
        """Do nothing, because there is no code to run."""


_PYTHON = os.path.dirname(os.__file__)
_asking: set[str] = set()
"""Packages from which a module has requested something of the kernel."""
_finder, _display = _Finder(PACKAGES, _Module), _Finder(DISPLAY, _DisplayModule)
_loading = threading.RLock()
_following: list[Callable[[], object]] = []
