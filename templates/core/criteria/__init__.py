"""Criteria compare a value with a limit, each with its error, and give one of four verdicts.

This package knows neither templates nor designs.

`criterion`   reads a declared criterion and checks its units
`bands`       computes the band of the true value from a value and its stated relative error
`comparison`  compares both sides and gives a verdict at every point and place
`worst`       finds the worst of several points and places
`evaluation`  evaluates a criterion from the values of its names
`judgement`   describes a judged criterion
`summary`     gives the verdict over several criteria, worst first
`limits`      reads the limits that a user types or takes from a library row
"""
