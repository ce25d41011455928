"""Films with mass-conserving cavitation, static and time-dependent."""
