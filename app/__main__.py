"""`python -m app …` is `crankwright …`."""

import sys

from app.workers.threads import use_one_thread

MACHINES = {"worker", "scheduler"}
"""Commands that begin at once: they need nothing of what the others import, such as the geometry kernel."""


def main() -> None:
    """Run the command line, with one thread for the numerical libraries."""
    use_one_thread()
    if MACHINES.intersection(sys.argv[1:2]):
        from app.workers.remote.commands import machines

        machines()
    from app.cli import main as run_command  # imports NumPy, which reads the environment once

    run_command()


if __name__ == "__main__":
    main()
