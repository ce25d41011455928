"""Forced torsional vibration of trains with branches, gears and dampers."""
