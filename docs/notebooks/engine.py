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
# # An engine: the film in its nine bearings
#
# `engine` computes the loads of an in-line four from its gas pressure and masses. `oil_film_cycle` computes
# the oil film of every main and big-end bearing over the cycle. The result is one table. The service does the
# same in one design, with revisions, solids and a report.

# %%
import matplotlib.pyplot as plt
import numpy as np

from templates import get
from templates.groups.petrol_engine import IN_LINE_FOUR

engine = get("engine", 1)(**IN_LINE_FOUR, crank_angle_step="5 deg")
f"{engine.mean_power.to('kW'):.1f~P} at 4500 rpm, {engine.mean_torque.to('N*m'):.0f~P}"

# %% [markdown]
# ## Loads
#
# The loads on the five main bearings follow from a crankshaft on elastic supports, because a rigid shaft on
# five supports has no unique loads. Each row of `elastic_main_load_x` is one main bearing.

# %%
angles = engine.crank_angle.to("deg").magnitude
mains = np.hypot(engine.elastic_main_load_x.to("kN").magnitude, engine.elastic_main_load_y.to("kN").magnitude)
pins = np.hypot(engine.crankpin_load_x.to("kN").magnitude, engine.crankpin_load_y.to("kN").magnitude)

figure, axes = plt.subplots(figsize=(6.4, 3.6))
for number, load in enumerate(mains, 1):
    axes.plot(angles, load, label=f"main {number}")
axes.plot(angles, pins[0], "--", label="big end 1")
axes.set(xlabel="crank angle [°]", ylabel="load [kN]", ylim=(0, None))
axes.legend(ncols=2)
axes.grid(alpha=0.3)

# %% [markdown]
# ## Films
#
# Each bearing gets its loads, its oil supply and its size. The shell of a main bearing has its groove in the
# block; the rod turns with the sleeve of a big end. The mobility method takes milliseconds for a bearing;
# level `supplied` marches a mass-conserving film, takes about a second, and states its numerical error.

# %%
oil_film_cycle = get("oil_film_cycle", 1)
COMMON = {
    "crank_angle": {"value": angles, "unit": "deg"},
    "load_sense": "sleeve_on_journal",
    "speed": "4500 rpm",
    "diametral_clearance": "0.055 mm",
    "dynamic_viscosity": "10 mPa*s",
    "permissible_film": "1 um",
    "groove_width": "3 mm",
    "groove_extent": "180 deg",
    "supply_pressure": "4 bar",
}


def film(loads, number, **more):
    """Return the film of one bearing; `loads` names the loads of its kind, such as `crankpin_load`."""
    axes = {f"load_{axis}": getattr(engine, f"{loads}_{axis}")[number] for axis in "xy"}
    return oil_film_cycle(**COMMON, **axes, **more)


films = {}
for number in range(5):
    sizes = {"bearing_diameter": "55.055 mm", "bearing_width": "20 mm", "groove_start": "-90 deg"}
    films[f"main {number + 1}"] = film("elastic_main_load", number, **sizes)
for number in range(4):
    sizes = {"bearing_diameter": "48.055 mm", "bearing_width": "22 mm", "groove_start": "90 deg"}
    sizes["sleeve_speed"] = engine.rod_angular_velocity[number]
    films[f"big end {number + 1}"] = film("crankpin_load", number, **sizes)

print(f"{'bearing':12}{'load':>10}{'film':>10}{'pressure':>12}{'loss':>10}")
for name, one in films.items():
    load, thickness = one.largest_load.to("kN"), one.minimum_film_thickness.to("um")
    pressure, loss = one.maximum_pressure.to("MPa"), one.power_loss.to("W")
    print(f"{name:12}{load:>10.1f~P}{thickness:>10.2f~P}{pressure:>12.0f~P}{loss:>10.0f~P}")

# %% [markdown]
# ## The thinnest film

# %%
thinnest = min(films, key=lambda name: films[name].minimum_film_thickness)
one = films[thinnest]
figure, axes = plt.subplots(figsize=(6.4, 3.6))
axes.plot(angles, one.film_thickness.to("um").magnitude)
axes.axhline(1, color="grey", linestyle="--")
axes.set(xlabel="crank angle [°]", ylabel="film thickness [µm]", title=thinnest, ylim=(0, None))
axes.grid(alpha=0.3)

# %% [markdown]
# The level and the stated error of this film (relative to the rigid, fed film; `None` means that no ensemble
# supports a bound), and whether the permissible film is kept:

# %%
one.level, one.error["minimum_film_thickness"], [str(warning) for warning in one.warnings]
