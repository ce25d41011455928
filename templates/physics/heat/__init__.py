"""Heat balances of films over a cycle."""
