"""What engines share: arrays of labels, input of points, parallel parts."""
