"""Fatigue under stresses of any direction that repeat: tensors, criteria, counting, strength."""
