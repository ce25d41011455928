"""What a journal bearing does under its film: oil, heat, friction, whirl, limits."""
