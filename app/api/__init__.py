"""Parts that REST routes share: dependencies, responses, event streams, and answers that jobs compute."""
