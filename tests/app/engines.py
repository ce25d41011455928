"""The gallery's engines, for tests that use a part of them."""

from app.designs.gallery.engine import FOUR


def four_cylinders(**inputs):
    """A step with the loads of the four-cylinder engine, its places as numbers; its bore is a parameter."""
    return {"template": "engine", "version": 1, "inputs": {**FOUR, **inputs}}


def bearings_of(document):
    """An engine's loads, films, shells and crankshaft, without torsion and life."""
    kept = ("bore", "pin_diameter", "pitch", "bearing")
    return {
        **document,
        "parameters": {name: document["parameters"][name] for name in kept},
        "steps": {name: document["steps"][name] for name in ("engine", "film")},
    }
