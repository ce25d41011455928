"""Response schemas for curves, evaluations and pressure fields."""
