"""What tools/docs is made of: pages from markdown, their links, the page of verification."""
