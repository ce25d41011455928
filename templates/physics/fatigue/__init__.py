"""Fatigue under multiaxial periodic stresses: tensors, criteria, cycle counting, strength."""
