"""The pressure field of a journal bearing's film, for a picture."""

from __future__ import annotations

from app.schemas.answers import Answer, Measured, Quantity, Values


class Field(Measured):
    """Numbers over the unrolled surface: [position along the shaft][angle]."""

    value: list[list[float]]
    unit: str


class FilmPressure(Answer):
    """Pressure over the unrolled surface of the bearing; angles begin at the narrowest gap."""

    bearing_diameter: Quantity
    angle: Values
    place: Values
    pressure: Field
    maximum_pressure: Quantity
    attitude_angle: Quantity
