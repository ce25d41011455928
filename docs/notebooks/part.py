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
# # A part: from worksheet to STEP
#
# The oil film sizes a bearing, a CAD model builds it, and a STEP file holds it; the file is then measured.
# All of this happens in Python. The [tutorial](../tutorial.md) does the same through the service, which adds
# revisions, relations and reports.

# %%
import io
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from cad.catalogue import models
from cad.export import derive
from cad.regenerate import regenerate
from templates import get

oil_film = get("oil_film", 2)

# %% [markdown]
# ## The question
#
# A load of 25 kN at 5000 rpm. How wide must half shells of 48 mm be so that their film is at least 4 µm? An
# array of widths answers for all of them at once.

# %%
widths = np.linspace(14, 36, 45)
bearing = {
    "radial_load": "25 kN",
    "diametral_clearance": "0.055 mm",
    "bearing_diameter": "48 mm",
    "bearing_width": {"value": widths, "unit": "mm"},
    "speed": "5000 rpm",
    "oil_inlet_temperature": "80 degC",
    "oil_outlet_temperature": "87.762 degC",
}
films = oil_film(**bearing)
thickness = films.minimum_film_thickness.to("um").magnitude
width = widths[np.argmax(thickness >= 4)]
print(f"narrowest width with at least 4 µm: {width:g} mm")

# %%
figure, axes = plt.subplots(figsize=(6.4, 3.6))
axes.plot(widths, thickness)
axes.axhline(4, color="grey", linestyle="--")
axes.plot(width, thickness[widths == width][0], "o")
axes.set(xlabel="bearing width [mm]", ylabel="minimum film thickness [µm]")
axes.grid(alpha=0.3)

# %% [markdown]
# ## The shells
#
# The model `plain_bearing` takes the bore from the calculation: the bearing diameter of the film. Whatever
# is not given has a default that fits: a pair of half shells with linings. A parameter out of its range would
# be refused by name before anything is drawn.

# %%
film = oil_film(**{**bearing, "bearing_width": f"{width} mm"})
plain_bearing = models().get("plain_bearing", 1)
shells = plain_bearing.from_quantities(
    {
        "inner_diameter": f"{film.bearing_diameter.to('mm').magnitude} mm",
        "width": f"{width} mm",
    }
)

# %% [markdown]
# ## The file
#
# `regenerate` draws the solid, writes it as STEP, reads that file again and checks it: one valid solid,
# the volume of its closed form, the box, and every parameter read back from its surfaces. It returns the
# build only if all of them hold.

# %%
build = regenerate("plain_bearing", 1, shells.inputs_si())
place = Path(tempfile.mkdtemp()) / "main_bearing.step"
place.write_bytes(build.step)
print(f"{place.name}: {len(build.step)} bytes, {1e3 * build.measures['mass']:.1f} g")
for name, value in build.dimensions.items():
    print(f"{name:24} {value:8.4f} {plain_bearing.inputs[name].meaning.unit}")

# %% [markdown]
# These dimensions were measured on the file, not copied from the request:

# %%
assert abs(build.dimensions["inner_diameter"] - film.bearing_diameter.to("mm").magnitude) < 1e-6
assert abs(build.dimensions["width"] - width) < 1e-6

# %%
picture = plt.imread(io.BytesIO(derive(build.step, "png")))
figure, axes = plt.subplots(figsize=(6.4, 4.8))
axes.imshow(picture)
axes.axis("off")
# %% [markdown]
# Equal parameters give equal bytes, so the file can be checked by its hash.

# %%
again = regenerate("plain_bearing", 1, shells.inputs_si())
assert again.step == build.step
