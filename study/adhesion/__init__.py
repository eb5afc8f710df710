"""What is known of adhesion before a contact is solved."""
