"""Shared by writers of text: rows, tables, lists, feature collections."""
