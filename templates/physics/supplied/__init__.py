"""Films fed by grooves or holes, marched over a cycle with conservation of mass."""
