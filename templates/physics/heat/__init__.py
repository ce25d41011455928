"""Heat balances of films over a load cycle."""
