"""Routes that evaluate and solve single templates, and read curves."""
