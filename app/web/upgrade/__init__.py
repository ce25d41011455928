"""The page that upgrades a design to newer versions."""
