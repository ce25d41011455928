"""Assumptions of film models on the unsafe side, as answers list them."""

from __future__ import annotations

RIGID = "journal and bore are rigid and round"
PARALLEL = "journal and bearing are parallel"
SMOOTH = "journal and bore are smooth"
ISOTHERMAL = "the film has one temperature"
FULL = "below level `supplied` the film is always full of oil"
