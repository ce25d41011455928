"""Run long work outside the server's process, with a deadline and a memory limit.

`LocalProcesses` is for geometry, `WarmProcesses` for calculations, `Inline` for tests; each is a `Worker`.
A job function reports its progress by `templates.core.progress.report`.
"""
