"""Run the command line: `python -m app …` does the same as `crankwright …`."""

import sys

from app.workers.threads import use_one_thread


def main() -> None:
    """Run the command line, with one thread for the numerical libraries."""
    use_one_thread()
    if sys.argv[1:2] == ["serve"]:
        from app.cli.start import begin_serving

        begin_serving()
    from app.cli.main import main as run_command  # after the setting above: NumPy reads the environment once

    run_command()


if __name__ == "__main__":
    main()
