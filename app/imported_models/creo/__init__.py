"""Draw models by a running Creo session, through CREOSON's JSON interface."""
