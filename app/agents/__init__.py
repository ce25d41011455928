"""Tools for agents: an MCP server that calls the service, and a skill that teaches its use.

The server has no engine of its own. It sends every question to the service with the caller's key, and
shortens the answer; the service decides verdicts, errors, roles and refusals.
"""
