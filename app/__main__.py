"""`python -m app …` is `crankwright …`."""

from app.workers.threads import use_one_thread


def main() -> None:
    """Run the command line, with one thread for the numerical libraries."""
    use_one_thread()
    from app.cli import main as run_command  # commands import NumPy, which reads the environment once

    run_command()


if __name__ == "__main__":
    main()
