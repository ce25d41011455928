"""Crank throw: two webs, the crankpin between them, and half a main journal on each side.

The part of a crankshaft from mid-journal to mid-journal, as stiffness formulas and finite elements take it.
Without oil drilling it is its own mirror image in z = 0, and always in y = 0. What its words mean is said in
the class below, which users read; parameters, rules and the solid are those of `cad.cranks`.
"""

from cad.cranks.crank import CrankModel
from templates.core.language.template import Array, formula


class CrankThrow(CrankModel):
    """Crank throw from mid-journal to mid-journal, solid or bored, with fillets and counterweights.

    z is the axis of the main journals, x points from it to the pin, z = 0 is mid-pin; the cut faces stand
    across the shaft at z = ±(pin_length + 2 web_thickness + journal_length)/2. Of the journal_length half is
    drawn on each side. A bore, fillet, oil drilling, counterweight or inclination of 0 is none.

    Fillets run round the pin and the journals where they meet a web. The journals' bore goes through the
    journals and their webs, the pin's through the pin and both webs. The oil drilling is straight: from
    mid-pin, on the side away from the shaft, through the web at +z, to mid-length of the half journal, on its
    other side. The counterweights are sectors about the shaft opposite to the pin, as thick as their webs.

    The face inclination takes material off the outer face of each web, from beside the journal's fillet to
    the end beyond the pin: 0 is the heaviest web. To add material there, as Punewale et al. do, make it
    smaller.

    Limits
    ------
    One throw with two webs alike, at least 2 % wider than journal and pin with their fillets. Journals and
    pin are plain cylinders without grooves; edges other than at the fillets are sharp; a counterweight spans
    at most half a turn.

    References
    ----------
    Punewale, Khobragade, Chaudhari and Khandre 2015: material on the face inclination of the webs, and what
        it does to stiffness.
    """

    example = {
        "journal_diameter": "55 mm",
        "journal_length": "40 mm",
        "journal_bore": "16 mm",
        "pin_diameter": "48 mm",
        "pin_length": "32 mm",
        "pin_bore": "14 mm",
        "web_thickness": "18 mm",
        "web_width": "80 mm",
        "throw": "42 mm",
        "fillet": "3 mm",
        "oil_drilling_diameter": "5 mm",
        "counterweight_radius": "75 mm",
        "counterweight_angle": "120 deg",
        "face_inclination": "8 deg",
    }
    toleranced = {
        "journal_diameter": {"cylinders": "z", "datum": "A", "cylindricity": 0.5},
        "journal_bore": {"cylinders": "z"},
        "pin_diameter": {"beside": "z", "cylindricity": 0.5, "parallelism": 1, "to": "A"},
        "pin_bore": {"beside": "z"},
        "throw": {"between": ["journal_diameter", "pin_diameter"]},
        "oil_drilling_diameter": {"askew": True},
        "pin_length": {"planes": "z", "levels": [[2, 3]], "perpendicularity": 1, "to": "A"},
        "web_thickness": {"planes": "z", "levels": [[1, 2], [3, 4]]},
    }

    @formula("mm", "journal length on each side", name="journal_side", symbol="L_s")
    def L_s(self) -> Array:
        return self.L_j / 2
