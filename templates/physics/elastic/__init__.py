"""Films in elastic bearings: liner, housing, and oil whose viscosity increases with pressure."""
