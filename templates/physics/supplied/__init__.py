"""Films that a groove or hole feeds, marched over a cycle with their oil conserved."""
