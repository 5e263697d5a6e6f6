"""Rows, tables, JSON lists, feature collections: what writers of text share."""
