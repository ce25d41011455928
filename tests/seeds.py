"""Seeds of random tests: the same requests in every run, others by `CRANKWRIGHT_TEST_SEED`.

`.ci/nightly` sets a new seed and prints it. Hypothesis takes it too, unless `--hypothesis-seed` is given.
Random tests take all their examples with a chosen seed, else a third of them.
"""

import os

CHOSEN = os.environ.get("CRANKWRIGHT_TEST_SEED")
SEED = int(CHOSEN or "0")


def examples(count):
    """How many of so many random examples a test takes: without a chosen seed a third."""
    return count if CHOSEN else -(-count // 3)


def seeded(number):
    """The seed of one test: its own number, or another one for each seed of the run."""
    return number + 1000 * SEED
