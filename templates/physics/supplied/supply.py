"""Oil supply of a film over a cycle: holes, slots and grooves in either surface, and their pressure.

Angles are positive in the sense of rotation. The axes of frame, sleeve and journal coincide at crank angle 0:
the angle of a hole in the pin is measured from the throw, that of a groove in the rod's bore from the rod's
axis.
"""

from dataclasses import dataclass

import numpy as np

LONGEST = 0.95
"""Largest half length of a pocket over B/2: beyond it the land at the bearing's end seals nothing [-]."""


@dataclass(frozen=True)
class Pocket:
    """A hole, slot or groove full of oil at the supply pressure, symmetric about the bearing's middle."""

    centre: float
    """Angle at crank angle 0, in the axes of the sleeve or, with on_journal, of the journal [rad]."""
    half_angle: float
    """Half the circumferential extent; pi for a full circle [rad]."""
    half_length: float
    """Half the axial extent over B/2, above 0 and at most 0.95 [-]."""
    on_journal: bool = False
    """Whether the pocket rotates with the journal; otherwise it is in the sleeve."""


@dataclass(frozen=True)
class Supply:
    """The oil supply of a film: at least one pocket, and a pressure above that of the cavities.

    Raises
    ------
    ValueError
        If there is no pocket, the pressure is not above 0, or a pocket's extent lies outside its range.
    """

    pockets: tuple[Pocket, ...]
    pressure: float
    """Supply pressure above ambient, P = p psi²/(eta Omega) [-]."""

    def __post_init__(self) -> None:
        if not self.pockets:
            raise ValueError("a supply needs at least one pocket")
        if not (0 < self.pressure < np.inf):
            raise ValueError("the supply pressure must be above 0, the pressure of the cavities")
        for pocket in self.pockets:
            if not 0 < pocket.half_angle <= np.pi:
                raise ValueError("half_angle of a pocket must lie in (0, pi] rad")
            if not 0 < pocket.half_length <= LONGEST:
                raise ValueError(f"half_length of a pocket must lie in (0, {LONGEST}] of half the width")

    @property
    def grooved(self) -> bool:
        """Return whether a pocket extends at least half around, so that the load passes over it."""
        return any(pocket.half_angle >= np.pi / 2 for pocket in self.pockets)

    @property
    def edges(self) -> tuple[float, ...]:
        """Return the distinct half lengths in ascending order [-]."""
        return tuple(sorted({pocket.half_length for pocket in self.pockets}))
