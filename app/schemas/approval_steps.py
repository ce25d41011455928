"""The steps in which a revision is approved, and the states between them."""

from __future__ import annotations

from typing import Literal, get_args

Step = Literal["calculated", "checked", "released", "withdrawn"]
ORDER: tuple[Step, ...] = get_args(Step)
"""The steps in order."""
ApprovalState = Literal["unsigned", "calculated", "checked", "released", "withdrawn"]
"""The last completed step; `unsigned` before the first."""
