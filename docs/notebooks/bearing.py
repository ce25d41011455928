# ---
# jupyter:
#   jupytext:
#     text_representation:
#       format_name: percent
#   kernelspec:
#     display_name: Python 3
#     language: python
#     name: python3
# ---

# %% [markdown]
# # A bearing: one film at all levels
#
# `oil_film` 2 computes the same bearing at five levels of fidelity. This notebook computes one case at
# each of them, measures what each costs, and draws the trade of speed for accuracy. MkDocs executes it
# whenever it builds this site, so every number below comes from the code as it is; the times are those of
# the machine that built the page.

# %%
import time

import matplotlib.pyplot as plt
import numpy as np

from templates import NoValue, get

oil_film = get("oil_film", 2)
oil_film.levels

# %% [markdown]
# The main bearing of the demonstration: 48 mm, 25 kN, 5000 rpm. Inputs are texts with their units, or Pint
# quantities. An attribute of the result is a Pint quantity too; it is computed when it is first asked for.

# %%
bearing = {
    "radial_load": "25 kN",
    "diametral_clearance": "0.055 mm",
    "bearing_diameter": "48 mm",
    "bearing_width": "18 mm",
    "speed": "5000 rpm",
    "oil_inlet_temperature": "80 degC",
    "oil_outlet_temperature": "87.762 degC",
}
film = oil_film(**bearing)
film.minimum_film_thickness, film.level, film.error["minimum_film_thickness"], film.warnings

# %% [markdown]
# The error is an estimate from measurements: the largest that was seen in the neighbourhood of this point.
# `None` means that nobody measured it.
#
# ## All levels side by side
#
# A level may have no value for an output: the fit of the standard gives no pressure. Python then raises
# `NoValue` with the reason.

# %%
OUTPUTS = ("minimum_film_thickness", "attitude_angle", "maximum_pressure", "friction_coefficient")


def shown(film, output):
    """The value with its unit, or that there is none."""
    try:
        return f"{getattr(film, output):.4g~P}"
    except NoValue:
        return "none"


films = {level: oil_film(**bearing, level=level) for level in oil_film.levels}
for level, one in films.items():
    print(f"{level:16}", *(f"{shown(one, output):>12}" for output in OUTPUTS))

# %% [markdown]
# `mass_conserving` counts shear only where there is oil, the other levels over the full circle: its
# friction is another quantity.
#
# ## What each level costs
#
# Processor time of the minimum film thickness, the shortest of a few runs.


# %%
def seconds(level, runs):
    """Processor seconds of one calculation at a level."""
    times = []
    for _ in range(runs):
        start = time.process_time()
        _ = oil_film(**bearing, level=level).minimum_film_thickness
        times.append(time.process_time() - start)
    return min(times)


cost = {level: seconds(level, runs=20 if level in ("short_bearing", "fit", "map") else 3) for level in films}
error = {level: one.error["minimum_film_thickness"] for level, one in films.items()}
for level in films:
    print(f"{level:16} {1e3 * cost[level]:9.2f} ms   estimated error {100 * error[level]:8.2g} %")

# %%
figure, axes = plt.subplots(figsize=(6.4, 4))
for level in films:
    axes.loglog(1e3 * cost[level], 100 * error[level], "o")
    axes.annotate(level, (1e3 * cost[level], 100 * error[level]), xytext=(6, 4), textcoords="offset points")
axes.set(xlabel="processor time of one point [ms]", ylabel="estimated error of the smallest film [%]")
axes.margins(x=0.3)
axes.set_xlim(right=3e3 * max(cost.values()))
axes.grid(alpha=0.3)

# %% [markdown]
# `map` is the level to use: it reads the converged solution from a table. One point costs about as much as
# a closed form, because most of that time is reading and checking the inputs. `reynolds` solves the same
# equation again, to check the map; `mass_conserving` is for grooves and supply pressure.
#
# ## Let a tolerance choose
#
# With `tolerance` the cheapest level is taken whose estimated error meets it, for the outputs named.

# %%
for tolerance in (1.0, 0.05, 0.001):
    chosen = oil_film(**bearing, tolerance=tolerance, outputs=["minimum_film_thickness"])
    print(f"{100 * tolerance:6.1f} %  {chosen.level:14} {chosen.minimum_film_thickness:.4f~P}")

# %% [markdown]
# ## Many points at once
#
# An array as input gives arrays. The same code runs for one point and for many, so a curve of 200 loads
# costs little more than one point.

# %%
loads = np.linspace(2, 60, 200)
swept = {
    level: oil_film(**{**bearing, "radial_load": {"value": loads, "unit": "kN"}}, level=level)
    for level in ("short_bearing", "fit", "map")
}

figure, axes = plt.subplots(figsize=(6.4, 4))
for level, one in swept.items():
    axes.plot(loads, one.minimum_film_thickness.to("um").magnitude, label=level)
axes.set(xlabel="radial load [kN]", ylabel="minimum film thickness [µm]", ylim=(0, None))
axes.legend()
axes.grid(alpha=0.3)

# %% [markdown]
# The short-bearing theory shows a film that is too thick at every load here, so it errs to the unsafe
# side.

# %%
thin, thick = swept["map"].minimum_film_thickness, swept["short_bearing"].minimum_film_thickness
bool(np.all(thick > thin))
