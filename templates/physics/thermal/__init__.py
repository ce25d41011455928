"""Films with varying viscosity: Dowson's equation and the energy equation."""
