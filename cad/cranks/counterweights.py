"""Counterweight radii of the webs (one number, or one for each web) and the rules for them."""

from __future__ import annotations

import numpy as np

from templates.core.language.template import Array, Truth, units


@units("rad", returns="1")
def count(angles: Array) -> Array:
    """Return the number of counterweight radii."""
    return np.asarray(float(np.shape(angles)[-1]))


@units("m", "1", returns="1")
def webs_of(radii: Array, throws: Array) -> Array:
    """Return the number of webs for which radii are given: all webs if there is a single number."""
    return 2 * throws if np.ndim(radii) == 0 else np.asarray(float(np.shape(radii)[-1]))


@units("m", returns="1")
def there_is_none(radii: Array) -> Truth:
    """Return whether no web has a counterweight."""
    return np.asarray(np.all(np.atleast_1d(radii) <= 0, axis=-1), dtype=bool)


@units("m", "m", returns="1")
def stand_out(radii: Array, least: Array) -> Truth:
    """Return whether each counterweight has at least this radius."""
    if np.ndim(radii) == 0:
        return (radii <= 0) | (radii >= least)
    return np.asarray(np.all((radii <= 0) | (radii >= np.expand_dims(least, -1)), axis=-1), dtype=bool)


@units("m", "rad", "1", returns="m**2", latex=r"R_w^2\,\varphi_w / 2")
def sectors(radii: Array, angle: Array, throws: Array) -> Array:
    """Return the area of each web's counterweight sector, measured from the journal axis [m²]."""
    each = np.atleast_1d(radii) ** 2 * np.expand_dims(angle, -1) / 2
    return np.broadcast_to(each, (*each.shape[:-1], round(float(2 * throws))))
