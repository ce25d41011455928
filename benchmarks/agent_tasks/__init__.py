"""Tasks for agents in words, with graded answers; see docs/agents.md."""
