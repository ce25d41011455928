"""Physics: forced torsional vibration of trains with branches, gears and dampers."""
