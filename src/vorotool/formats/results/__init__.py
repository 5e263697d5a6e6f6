"""Writers (and the reader back) of result types."""
