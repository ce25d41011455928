"""Variants of a design: named sets of values that override some of its parameters and inputs."""
