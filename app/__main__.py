"""`python -m app …` is `crankwright …`."""

from app.cli import main

main()
