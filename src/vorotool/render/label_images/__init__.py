"""Pictures of label images."""
