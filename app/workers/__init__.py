"""Where long work runs: outside the server's process, under a deadline and a memory limit.

`LocalProcesses` is for service, `Inline` for tests; both are a `Worker`. A job function tells how far it is
by `app.workers.progress.report`.
"""
