"""Zarr stores: metadata, chunks, codecs, writing."""
