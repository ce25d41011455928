"""Torsion, stress concentration and fatigue of shafts."""
