"""Draw models with a running Creo session, through CREOSON's JSON interface."""
