"""Units, quantities, and relations with their grammar."""
