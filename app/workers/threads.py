"""Threads of the numerical libraries: one in each process, unless the operator sets another number.

The service fills the cores with processes. With more threads, those of OpenBLAS wait for each other: with two
busy processes on the machine they multiplied the processor time of small linear algebra by six.
"""

import os

ONE_THREAD = dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"), "1")
"""Environment variables that the libraries read when they are loaded."""


def use_one_thread() -> None:
    """Set the environment variables for this process and its children; call this before NumPy is imported."""
    for name, number in ONE_THREAD.items():
        os.environ.setdefault(name, number)
