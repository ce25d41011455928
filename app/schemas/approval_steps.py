"""The steps in which a revision is approved, and the states between them."""

from __future__ import annotations

from typing import Literal, get_args

Step = Literal["calculated", "checked", "released", "withdrawn"]
ORDER: tuple[Step, ...] = get_args(Step)
"""The steps, one after another."""
ApprovalState = Literal["unsigned", "calculated", "checked", "released", "withdrawn"]
"""The last step that was taken; `unsigned` before the first."""
