"""Relative eccentricity from load, for any load function that increases with eccentricity.

The unknown is logit(eps), bracketed from eps 1e-20 to 1 − 1e-7, and the residual is the logarithm of the
load. Both ends are therefore resolved equally well, and the search cannot leave its bracket.
"""

from collections.abc import Callable

import numpy as np
from scipy.special import expit, logit

from templates.core.arrays import Array
from templates.physics.numerics.arrays import ECCENTRICITY_LIMIT, require
from templates.physics.numerics.roots import bracketed_root

_LOWEST = 1e-20


def eccentricity(load: Callable[..., Array], So: Array, *parameters: Array) -> Array:
    """Return eps for which load(eps, *parameters) = So [-].

    Parameters
    ----------
    load
        A function of eps and the parameters, elementwise and strictly increasing with eps.
    So
        Sommerfeld number, 0 or more; any shape that broadcasts with the parameters [-].
    parameters
        Further arguments of the load function, such as the width ratio.

    Returns
    -------
    eps; 0 where So is 0, NaN where So is more than the film carries at eps 1 − 1e-7.

    Raises
    ------
    ValueError
        If So is negative or not finite, or the load function refuses a parameter.

    Examples
    --------
    >>> from templates.physics.films.short_bearing import load_Ocvirk_1952
    >>> round(float(eccentricity(load_Ocvirk_1952, 1.500762164, 1.0)), 8)
    0.5
    """
    So = np.asarray(So, float)
    require(np.isfinite(So) & (So >= 0), "So must be 0 or more and finite")
    So, *parameters_ = np.broadcast_arrays(So, *parameters)
    logarithm = np.log(np.where(So > 0, So, 1.0))

    def excess(u: Array) -> Array:
        eps = np.minimum(expit(u), ECCENTRICITY_LIMIT)
        return np.asarray(np.log(load(eps, *parameters_)) - logarithm)

    root = bracketed_root(
        excess, np.full(So.shape, logit(_LOWEST)), np.full(So.shape, logit(ECCENTRICITY_LIMIT))
    )
    return np.where(So > 0, expit(root), 0.0)
