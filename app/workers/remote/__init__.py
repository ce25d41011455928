"""Jobs on other machines: Dask carries packed functions to them, and each runs in a process of its own there.

`DaskWorker` is the `BatchWorker` of a server, `Machine` is what `crankwright worker` runs. Only these import
`distributed`, of the extra `team`. docs/decisions/052 says why it is done so.
"""
