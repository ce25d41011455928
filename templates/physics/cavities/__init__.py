"""Films with mass-conserving cavities, static and over time."""
