"""Properties of a journal bearing: oil, heat, friction, whirl, limits."""
