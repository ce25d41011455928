"""Run jobs on other machines: Dask transfers packed functions, and each runs there in a separate process.

`DaskWorker` is the `BatchWorker` of a server; `crankwright worker` runs a `Machine`. Only these import
`distributed`, which belongs to the extra `team`. docs/decisions/052 gives the reasons.
"""
