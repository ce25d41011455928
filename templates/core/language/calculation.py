"""A record of one calculation: declarations, values by attribute, and the inputs behind each value."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, ClassVar, NoReturn, Protocol

import numpy as np

from templates.core.criteria.criterion import Criterion
from templates.core.language.ledger import Ledger
from templates.core.language.spec import (
    Declaration,
    Formula,
    Input,
    Requirement,
    Shared,
)


class Written(Protocol):
    """The worksheet from which a class was made."""

    @property
    def text(self) -> str:
        """Return the worksheet as it was written."""

    def digest(self) -> str:
        """Return the SHA-256 of the calculating statements, without prose and layout."""

    @property
    def is_exact(self) -> bool:
        """Return whether its results have no error of their own, as those of a design's lines."""


class Calculation:
    """The values of one calculation and the declarations of its class; `Template` reads and checks inputs."""

    id: ClassVar[str] = ""
    version: ClassVar[int] = 0
    withdrawn: ClassVar[str | None] = None
    sheet: ClassVar[Written | None] = None  # the worksheet that it was made from
    example: ClassVar[Mapping[str, Any]] = {}
    assumptions: ClassVar[tuple[str, ...]] = ()  # of the model, on the unsafe side; one sentence each
    criteria: ClassVar[Mapping[str, Any]] = {}  # by name: `"film >= limit"`, or an object with `require`
    main_results: ClassVar[tuple[str, ...]] = ()  # the inputs and outputs that a table of designs shows
    precision: ClassVar[float] = (
        1e-12  # relative precision to which results of a released version must agree; solvers: 1e-8
    )
    level_precision: ClassVar[
        Mapping[str, float]
    ] = {}  # of levels that are less reproducible on other machines

    inputs: ClassVar[dict[str, Input]] = {}
    formulas: ClassVar[dict[str, Formula[Any]]] = {}
    requirements: ClassVar[tuple[Requirement, ...]] = ()
    declarations: ClassVar[dict[str, Declaration]] = {}
    intermediates: ClassVar[dict[str, Shared[Any]]] = {}
    declared_criteria: ClassVar[tuple[Criterion, ...]] = ()

    levels: ClassVar[tuple[str, ...]] = ()  # fidelities, cheapest first
    default_level: ClassVar[str] = ""
    most_points: ClassVar[Mapping[str, int]] = {}  # that an expensive level accepts at once
    level: str

    _ancestry: ClassVar[dict[str, frozenset[str]]] = {}
    _dependencies: ClassVar[dict[str, frozenset[str]]] = {}
    _results: ClassVar[frozenset[str]] = frozenset()  # attributes of formulas
    _result_names: ClassVar[frozenset[str]] = frozenset()
    _derived: ClassVar[frozenset[str]] = frozenset()  # names of inputs whose default is a formula
    _curves: ClassVar[frozenset[str]] = frozenset()  # names of formulas that are profiles
    _remarks: ClassVar[tuple[Requirement, ...]] = ()  # the rules that refuse nothing
    _readings: ClassVar[tuple[tuple[Declaration, str], ...]] = ()  # formulas that can be read in two ways
    ledger: Ledger

    def __init__(self, values: Mapping[str, Any], ledger: Ledger | None = None) -> None:
        """Set SI values by attribute, unchecked; user input goes through `from_quantities`."""
        self.__dict__.update(values)
        self.__dict__.setdefault("level", self.default_level)
        self.__dict__["ledger"] = ledger or Ledger()
        self.ledger.handed = frozenset(values)

    def __setattr__(self, name: str, value: object) -> NoReturn:
        raise AttributeError(
            f"a {type(self).__name__} is a record of one calculation and cannot change; create a new one"
        )

    def __delattr__(self, name: str) -> NoReturn:
        self.__setattr__(name, None)

    def as_given(self, attribute: str) -> Any:
        """Return the value of an input as given or by default; NaN if a formula must compute it.

        Pass the attribute as a literal, because the language finds the dependencies of a formula in its
        source.
        """
        return vars(self)[attribute] if attribute in self.ledger.handed else np.float64(np.nan)

    @classmethod
    def ancestors(cls, attribute: str) -> frozenset[str]:
        """Return the attributes on which this one depends, directly or indirectly, including itself."""
        if attribute not in cls._ancestry:
            cls._ancestry[attribute] = frozenset(cls._beneath(attribute))
        return cls._ancestry[attribute]

    @classmethod
    def dependencies(cls, attribute: str) -> frozenset[str]:
        """Return the ancestors of an attribute, and the inputs that any of them reads as given.

        A formula for the default of an input may read this input as given, so the result does not define an
        order of evaluation.
        """
        if attribute not in cls._dependencies:
            ancestors = cls.ancestors(attribute)
            as_given = (getattr(cls._node(name), "uses_as_given", ()) for name in ancestors)
            cls._dependencies[attribute] = ancestors.union(*as_given)
        return cls._dependencies[attribute]

    def depends_on(self, attribute: str) -> frozenset[str]:
        """Return the dependencies of an attribute in this calculation.

        An input that is read as given counts only if the user gave it.
        """
        ancestors = self.ancestors(attribute)
        return ancestors | (self.dependencies(attribute) & self.ledger.handed)

    @classmethod
    def _node(cls, attribute: str) -> Declaration | Shared[Any] | None:
        return cls.declarations.get(attribute) or cls.intermediates.get(attribute)

    @classmethod
    def _beneath(cls, attribute: str) -> Iterator[str]:
        attributes, waiting = {attribute}, [attribute]
        while waiting:
            yield (name := waiting.pop())
            new = dict.fromkeys(n for n in getattr(cls._node(name), "uses", ()) if n not in attributes)
            attributes |= new.keys()
            waiting += new
