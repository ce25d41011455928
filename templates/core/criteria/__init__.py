"""Criteria: a value against a limit, each with its error; four verdicts. Knows no template and no design.

`criterion`   reads a criterion as it is declared, and checks its units
`bands`       where the truth lies around a value whose relative error is stated
`comparison`  one side against the other: a verdict for every point and place
`worst`       which of several points and places is the worst
`evaluation`  from the values of its names to a criterion as judged
`judgement`   a criterion as judged
`summary`     the verdict over several criteria, worst first
`limits`      the limits that a user gives, by hand or by a row of a library
"""
