"""Stiffness of cranks: torsion, vibration, fatigue."""
