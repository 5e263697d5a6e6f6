"""What writers of text share: rows, tables, lists, feature collections."""
