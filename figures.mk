# One rule a figure of the paper; its body is a vorotool pipeline.
