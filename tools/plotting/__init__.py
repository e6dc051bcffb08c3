"""Pictures of Quicksand results."""
