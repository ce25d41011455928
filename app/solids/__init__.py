"""What a build's key finds: builds, their files, measurements and analyses."""
