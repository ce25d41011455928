"""Stiffness, vibration and fatigue strength of cranks and shafts."""
