"""The skill: the text that teaches agents the use of the tools."""

from importlib.resources import files


def skill() -> str:
    """Return the skill as Markdown."""
    return files("app.agents").joinpath("SKILL.md").read_text(encoding="utf-8")
