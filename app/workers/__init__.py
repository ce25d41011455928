"""Run long work outside the server's process, under a deadline and a memory limit.

`LocalProcesses` is for geometry, `WarmProcesses` for calculations, `Inline` for tests; all are a `Worker`.
A job function reports its progress by `templates.core.progress.report`.
"""
