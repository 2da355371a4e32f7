class LiveLog {}
