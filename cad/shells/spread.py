"""Free spread: the shape of a free half shell, which is wider at its joints than the seat.

The free shell is built as an arc of a larger radius: the middle line of the wall keeps the length that it has
in the housing, and each crush height remains a straight leg. So the curvature changes by the same amount
everywhere, as in a thin ring under a uniform moment; the seat forces the arc back to a half circle.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, cos, degrees, pi, sin

import numpy as np

from cad.revolution import nearest
from cad.shells.half_shell import HalfShell
from cad.shells.shell_readback import ShellReadback, off_axis
from cad.surfaces import Surface, X, Y, Z
from templates.core.language.declare import on_paper
from templates.core.language.template import Array, units

_STEPS = 12  # steps of Newton's method, each of which doubles the correct digits


@on_paper("solved by Newton's method from a quarter turn on")
@units("m", "m", "m", "m", returns="rad")
def half_angle(length: Array, wall: Array, crush: Array, width: Array) -> Array:
    """Return the angle from the crown to a joint of a free shell [rad].

    The outer edges of the joints are `width` apart: 2 ((s/φ + t/2) sin φ + a cos φ) = W.

    Parameters
    ----------
    length
        s, from the crown to the start of the straight leg, along the middle of the wall [m].
    wall, crush
        t and a, the thickness of the wall and the height of the leg [m].
    width
        W, the width over the joints [m].

    Notes
    -----
    W decreases with the angle up to a quarter turn and is concave, so Newton's method converges monotonically
    from there. If no angle between 0.5 rad and a quarter turn fits, the result is one of these limits.
    """
    angle = np.full(np.broadcast_shapes(*map(np.shape, (length, wall, crush, width))), pi / 2)
    for _ in range(_STEPS):
        sine, cosine = np.sin(angle), np.cos(angle)
        over = 2 * ((length / angle + wall / 2) * sine + crush * cosine) - width
        slope = length * (angle * cosine - sine) / angle**2 + wall / 2 * cosine - crush * sine
        angle = np.clip(angle - over / (2 * slope), 0.5, pi / 2)
    return angle


@dataclass(frozen=True)
class FreeShellReadback(ShellReadback):
    """A free half shell: its arc gives the sizes in the housing, and its joints give the spread."""

    @property
    def angle(self) -> float:
        """Return the angle from the crown to a joint [rad]; the legs are tangential to the arc there."""
        return nearest(map(_from_crown, self._joints()), pi / 2 - self.wanted.lift)

    def _upright(self) -> list[Surface]:
        return [plane for plane in self.back.planes if not plane.along(Z)]

    def _joints(self) -> list[Surface]:
        """Return the planes at the ends of the wall."""
        away = nearest(map(off_axis, self._upright()), self.wanted.crush)
        return [plane for plane in self._upright() if abs(off_axis(plane) - away) < 1e-6]

    def free_sizes(self, *, with_oil: bool) -> dict[str, float]:
        """Return every parameter by name."""
        angle, crush = self.angle, off_axis(self._joints()[0])
        fitted = (self.bore + self.wall / 2) * angle / (pi / 2)
        width = 2 * (self.outside * sin(angle) + crush * cos(angle))
        groove = self.groove() if with_oil else {}
        if "oil_groove_angle" in groove and self.wanted.groove and not self.wanted.groove.is_whole:
            groove["oil_groove_angle"] = degrees(self.groove_turn * (pi / 2) / angle)
        flange = self.flange()
        if self.wanted.flange:
            flange["flange_diameter"] -= 2 * (self.bore + self.wall / 2 - fitted)
        return {
            "inner_diameter": 2 * fitted - self.wall,
            "wall": self.wall,
            "wall_reduction": 0.0,
            "width": self.back.length(Z),
            "lining_thickness": self.lining_wall,
            "crush_height": crush,
            "free_spread": width - (2 * fitted + self.wall),
            **self.chamfers(),
            **self.relief(),
            **self.tang(),
            **flange,
            **groove,
        }


def reach_of(shell: HalfShell) -> tuple[float, float, float]:
    """Return the extents of a shell [mm]: on the side without a tang, on the side with one, and downwards."""
    lift, crush = shell.lift, shell.crush
    collar = shell.flange.radius if shell.flange else shell.outside
    lip = shell.outside + shell.tang.height if shell.tang else 0.0
    inside = shell.bore + (shell.relief.depth if shell.relief else 0.0)
    left, right = (radius * cos(lift) + crush * sin(lift) for radius in (collar, max(collar, lip)))
    return left, right, inside * sin(lift) - crush * cos(lift)


def _from_crown(plane: Surface) -> float:
    """Return the angle [rad] between a plane along the shaft and the plane of crown and shaft."""
    return atan2(abs(plane.direction.dot(Y)), abs(plane.direction.dot(X)))
