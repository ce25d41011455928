"""Analyses of solids by finite elements: what can be asked, jobs that find it, what was found before."""
