"""Jobs on other machines: Dask carries packed functions to them, and each runs in a process of its own there.

`DaskWorker` is the `BatchWorker` of a server; `crankwright worker` runs a `Machine`. Only these import
`distributed`, of the extra `team`. docs/decisions/052 gives the reasons.
"""
