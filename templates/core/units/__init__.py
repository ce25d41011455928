"""Units, quantities, tolerances, and relations with their grammar."""
