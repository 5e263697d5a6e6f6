"""Features of maps: geometry with attributes, ids and a reference system, from files that libraries read and write."""
