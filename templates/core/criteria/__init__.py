"""Criteria: a value against a limit, each with its error; four verdicts. Knows no templates and no designs.

`criterion`   reads a criterion as it is declared, and checks its units
`bands`       the band of the true value around a value with a stated relative error
`comparison`  compares both sides: a verdict for every point and place
`worst`       the worst of several points and places
`evaluation`  evaluates a criterion from the values of its names
`judgement`   a criterion as judged
`summary`     the verdict over several criteria, worst first
`limits`      the limits that a user types or takes from a library row
"""
